// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Requests beside the live data.

export async function post(path) {
  try {
    const response = await fetch(new URL(path, location.href), { method: "POST" });
    return await response.json();
  } catch (error) {
    return { error: `manycore view does not answer: ${error.message}` };
  }
}
