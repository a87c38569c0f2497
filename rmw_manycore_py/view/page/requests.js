// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Requests beside the live data.

export function get(path) {
  return ask(path, "GET");
}

export function post(path) {
  return ask(path, "POST");
}

async function ask(path, method) {
  try {
    const response = await fetch(new URL(path, location.href), { method });
    return await response.json();
  } catch (error) {
    return { error: `manycore view does not answer: ${error.message}` };
  }
}
