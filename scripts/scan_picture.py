#!/usr/bin/env python3
# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Take a screenshot of a scan in `manycore view`: scripts/scan_picture.py LINK FILE.png."""

from __future__ import annotations

import sys
import time

from page_picture import chromium
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

TIMEOUT_S = 60.0
ON_THE_WAY_S = 8.0  # until the vehicle is in the middle of the street
SELECT = """
const path = "//button[.='topic /points_aligned']";
const found = document.evaluate(path, document).iterateNext();
found?.click();
return found !== null;
"""


def main(link: str, file: str) -> None:
    """Show the aligned scans, wait for map and judgement, and take the screenshot."""
    with chromium() as driver:
        waiting = WebDriverWait(driver, TIMEOUT_S)
        driver.get(link)
        waiting.until(lambda _: driver.execute_script(SELECT))
        driver.find_element(By.ID, "samples").click()
        waiting.until(lambda _: "grey:" in driver.find_element(By.ID, "cloud-text").text)
        waiting.until(lambda _: driver.find_element(By.ID, "cloud-judgement").text)
        driver.find_element(By.ID, "cloud-large").click()
        time.sleep(ON_THE_WAY_S)
        driver.find_element(By.ID, "cloud-fit").click()
        driver.save_screenshot(file)


if __name__ == "__main__":
    main(*sys.argv[1:])
