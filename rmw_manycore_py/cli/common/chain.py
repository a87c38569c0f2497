# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Chains of topics as options."""

from __future__ import annotations

import click


class ChainText(click.types.StringParamType):
    """Topics, separated by spaces."""

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Return the value unless it has no topic."""
        if not value.split():
            self.fail("expected topics separated by spaces, found none", param, ctx)
        return value


chains_option = click.option(
    "--chain",
    "chains",
    multiple=True,
    type=ChainText(),
    help="Only this chain: topics separated by spaces.",
)
