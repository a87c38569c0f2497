#!/usr/bin/env python3
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Take a screenshot of `manycore view`: scripts/page_picture.py LINK TOPIC FILE.png."""

from __future__ import annotations

import os
import shutil
import sys
import time

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

TIMEOUT_S = 30.0
HISTORY_S = 20.0  # time shown by the charts


def chromium() -> webdriver.Chrome:
    """Return headless Chromium with one window."""
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium") or ""
    options.add_argument("--headless=new")
    options.add_argument("--window-size=1500,1000")
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")
    return webdriver.Chrome(options, webdriver.ChromeService(shutil.which("chromedriver")))


def main(link: str, topic: str, file: str) -> None:
    """Start a trace, select a topic on the page, wait for its charts, and take the screenshot."""
    with chromium() as driver:
        waiting = WebDriverWait(driver, TIMEOUT_S)
        driver.get(link)
        selector = f"[data-topic='{topic}']"
        arc = waiting.until(lambda _: driver.find_element(By.CSS_SELECTOR, selector))
        driver.find_element(By.ID, "trace").click()
        time.sleep(HISTORY_S)
        arc.send_keys(Keys.ENTER)
        waiting.until(lambda _: driver.find_elements(By.CSS_SELECTOR, "#details-charts canvas"))
        driver.save_screenshot(file)


if __name__ == "__main__":
    main(*sys.argv[1:])
