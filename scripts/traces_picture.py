#!/usr/bin/env python3
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Take a screenshot of two traces: scripts/traces_picture.py LINK TOPIC FILE.png."""

from __future__ import annotations

import sys

from page_picture import TIMEOUT_S, chromium
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

MIDDLE = "moment.value = 300; moment.dispatchEvent(new Event('input'))"


def main(link: str, topic: str, file: str) -> None:
    """Select a topic in the first trace, move to its middle, and wait for the second one."""
    with chromium() as driver:
        waiting = WebDriverWait(driver, TIMEOUT_S)
        driver.get(link)
        first, second = driver.find_elements(By.TAG_NAME, "iframe")
        driver.switch_to.frame(first)
        selector = f"[data-topic='{topic}']"
        arc = waiting.until(lambda _: driver.find_element(By.CSS_SELECTOR, selector))
        arc.send_keys(Keys.ENTER)
        driver.execute_script(MIDDLE)
        driver.switch_to.parent_frame()
        driver.switch_to.frame(second)
        waiting.until(lambda _: driver.find_elements(By.CSS_SELECTOR, "#details-charts canvas"))
        driver.switch_to.parent_frame()
        driver.save_screenshot(file)


if __name__ == "__main__":
    main(*sys.argv[1:])
