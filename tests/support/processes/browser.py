# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A real headless browser."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

from support import TIMEOUT_S

WINDOW = (1500, 900)
KEEP_SOCKETS = """
globalThis.sockets = [];
globalThis.WebSocket = class extends WebSocket {
  constructor(...words) { super(...words); sockets.push(this); }
};
"""


class Browser:
    """Chromium with one page."""

    def __init__(self, downloads: Path) -> None:
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium") or ""
        options.add_argument("--headless=new")
        options.add_argument(f"--window-size={WINDOW[0]},{WINDOW[1]}")
        if os.geteuid() == 0:
            options.add_argument("--no-sandbox")  # root cannot use it
        options.add_argument("--disable-dev-shm-usage")  # tests check what is left in /dev/shm
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        options.add_experimental_option("prefs", {"download.default_directory": str(downloads)})
        service = webdriver.ChromeService(shutil.which("chromedriver"))
        self.downloads = downloads
        self._scripts: list[dict[str, str]] = []  # for pages opened later
        self.driver = webdriver.Chrome(options=options, service=service)

    def open(self, link: str) -> None:
        self.driver.get(link)

    def open_in_new_tab(self, link: str) -> None:
        self.driver.switch_to.new_window("tab")
        self.open(link)

    def tabs(self) -> Iterator[None]:
        """Bring each tab to the front, one after the other."""
        for tab in self.driver.window_handles:
            self.driver.switch_to.window(tab)
            yield

    def forget(self) -> None:
        """Close all tabs and open an empty one for the next test."""
        first, *others = self.driver.window_handles
        for tab in others:
            self.driver.switch_to.window(tab)
            self.driver.close()
        self.driver.switch_to.window(first)
        self.driver.get("about:blank")
        self.complaints()
        for script in self._scripts:
            self.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
        self._scripts.clear()

    def keep_sockets(self) -> None:
        """Make later pages keep their WebSockets in `sockets`, for scripts."""
        found = self.driver.execute_cdp_cmd(
            "Page.addScriptToEvaluateOnNewDocument", {"source": KEEP_SOCKETS}
        )
        self._scripts.append(found)

    def press(self, selector: str | None, *keys: str) -> None:
        """Press keys, by name, on an element or on what has the focus."""
        if selector:
            self.driver.execute_script("arguments[0].focus()", self.find(selector))
        for key in keys:  # to whatever has the focus: the page may replace that element meanwhile
            pressed = getattr(Keys, key.upper(), key) if len(key) > 1 else key
            ActionChains(self.driver).send_keys(pressed).perform()

    def focused(self, attribute: str) -> str | None:
        return self.driver.switch_to.active_element.get_attribute(attribute)

    def focused_text(self) -> str:
        return str(self.driver.execute_script("return document.activeElement.textContent"))

    def accessible(self) -> list[tuple[str, str]]:
        """Return role and name of every node of the accessibility tree."""
        nodes = self.driver.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
        return [
            (node["role"]["value"], node.get("name", {}).get("value", ""))
            for node in nodes
            if not node["ignored"]
        ]

    def find(self, selector: str) -> Any:
        """Return the first element of a CSS selector, once it exists."""
        return self.until(lambda: self.all(selector), selector)[0]

    def all(self, selector: str) -> list[Any]:
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def click(self, selector: str) -> None:
        """Click by script: an overlapping element does not intercept it."""
        self.find(selector)
        self.driver.execute_script(
            "document.querySelector(arguments[0])"
            ".dispatchEvent(new MouseEvent('click', {bubbles: true}))",
            selector,
        )

    def text(self, selector: str) -> str:
        """Return the text of an element, "" while it does not exist."""
        return str(
            self.driver.execute_script(
                "return document.querySelector(arguments[0])?.textContent ?? ''", selector
            )
        )

    def until(self, condition: Callable[[], Any], what: str) -> Any:
        waiting = WebDriverWait(self.driver, TIMEOUT_S, poll_frequency=0.05)
        return waiting.until(lambda _: condition(), f"not within {TIMEOUT_S:g} s: {what}")

    def wait_for_text(self, selector: str, text: str) -> None:
        self.until(lambda: text in self.text(selector), f"{text!r} in {selector}")

    def complaints(self) -> list[str]:
        """Return errors and warnings of the page's console."""
        return [str(entry["message"]) for entry in self.driver.get_log("browser")]

    def close(self) -> None:
        self.driver.quit()
