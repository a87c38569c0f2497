# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A real browser without a window."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait
from support import PATIENCE_S

WINDOW = (1500, 900)


class Browser:
    """Chromium with one page."""

    def __init__(self, downloads: Path) -> None:
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium") or ""
        options.add_argument("--headless=new")
        options.add_argument(f"--window-size={WINDOW[0]},{WINDOW[1]}")
        if os.geteuid() == 0:
            options.add_argument("--no-sandbox")  # which root cannot have
        options.add_argument("--disable-dev-shm-usage")  # tests watch what is left there
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        options.add_experimental_option("prefs", {"download.default_directory": str(downloads)})
        service = webdriver.ChromeService(shutil.which("chromedriver"))
        self.driver = webdriver.Chrome(options=options, service=service)

    def open(self, link: str) -> None:
        self.driver.get(link)

    def find(self, selector: str) -> Any:
        """Return the first element of a CSS selector, once it is there."""
        return self.until(lambda: self.all(selector), selector)[0]

    def all(self, selector: str) -> list[Any]:
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def click(self, selector: str) -> None:
        """Click as a script does: nothing that lies above keeps it off."""
        self.find(selector)
        self.driver.execute_script(
            "document.querySelector(arguments[0])"
            ".dispatchEvent(new MouseEvent('click', {bubbles: true}))",
            selector,
        )

    def text(self, selector: str) -> str:
        """Return the text of an element, "" while there is none."""
        return str(
            self.driver.execute_script(
                "return document.querySelector(arguments[0])?.textContent ?? ''", selector
            )
        )

    def until(self, condition: Callable[[], Any], what: str) -> Any:
        waiting = WebDriverWait(self.driver, PATIENCE_S, poll_frequency=0.05)
        return waiting.until(lambda _: condition(), f"not within {PATIENCE_S:g} s: {what}")

    def wait_for_text(self, selector: str, text: str) -> None:
        self.until(lambda: text in self.text(selector), f"{text!r} in {selector}")

    def complaints(self) -> list[str]:
        """Return errors and warnings of the page's console."""
        return [str(entry["message"]) for entry in self.driver.get_log("browser")]

    def close(self) -> None:
        self.driver.quit()
