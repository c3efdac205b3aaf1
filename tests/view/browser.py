# SPDX-License-Identifier: Apache-2.0
"""Opens pages of `tesserae view` in a real browser, without a screen and without a graphics card."""

import json

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

# Software GL, so that the same page gives the same numbers on every machine.
OPTIONS = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
           "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--hide-scrollbars",
           "--force-device-scale-factor=1", "--window-size=1280,800"]


class Browser:
    """Chromium with one page at a time; use with `with`."""

    def __enter__(self):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for option in OPTIONS:
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_script_timeout(120)
        return self

    def __exit__(self, *_):
        self.driver.quit()

    def open(self, path):
        """Loads a page and waits until it is ready."""
        self.driver.get("file://" + str(path))
        self.run("await tesserae.ready")

    def run(self, script, *arguments):
        """The value of an asynchronous script's body; `args` holds the arguments."""
        outcome = self.driver.execute_async_script(
            "const done = arguments[arguments.length - 1], args = [...arguments].slice(0, -1);"
            "(async () => {" + script + "})().then((value) => done({value}),"
            " (error) => done({error: String(error && error.stack || error)}))", *arguments)
        if "error" in outcome:
            raise RuntimeError(outcome["error"])
        return outcome.get("value")

    def complaints(self):
        """What stands in the console as warning or error since the last call."""
        return [entry["message"] for entry in self.driver.get_log("browser")
                if entry["level"] in ("WARNING", "SEVERE")]

    def picture(self, path):
        """Saves what the window shows."""
        self.driver.save_screenshot(str(path))

    def window(self, width, height):
        self.driver.set_window_size(width, height)


def js(value):
    """A value as a literal of a script."""
    return json.dumps(value)
