"""A page in headless Chromium, as people meet it: of any width, light or dark, with or without scripts."""

import json
import shutil
import time

import pytest

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--hide-scrollbars",
)


class Browser:
    """Keeps what the pages that it opened complained of and asked for."""

    def __init__(self):
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        found = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")]
        binary, driver = next(filter(None, found), None), shutil.which("chromedriver")
        if binary is None or driver is None:
            pytest.skip("no chromium with its chromedriver on this machine")
        options = webdriver.ChromeOptions()
        options.binary_location = binary
        for flag in FLAGS:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.opened, self.width = None, 0
        self.driver = webdriver.Chrome(options=options, service=Service(driver))

    def tell(self, command, **parameters):
        return self.driver.execute_cdp_cmd(command, parameters)

    def open(self, page, width=1280, dark=False, script=True, anew=True):
        """Open a page, unless it is open so already and need not be opened `anew`."""
        wanted = (page, width, dark, script)
        if self.opened == wanted and not anew:
            return
        self.opened, self.width = wanted, width
        phone = width < 500
        self.tell(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=844 if phone else 900,
            deviceScaleFactor=1,
            mobile=phone,
        )
        self.tell("Emulation.setTouchEmulationEnabled", enabled=phone)
        self.colours(dark)
        self.tell("Emulation.setScriptExecutionDisabled", value=not script)
        self.driver.get_log("browser"), self.driver.get_log("performance")
        # A page that is opened once more may still be the old one for a moment, and forget what it is told.
        self.js("window.footfallWasOpen = true")
        self.driver.get(page.as_uri())
        self.wait("!window.footfallWasOpen && document.readyState === 'complete'")

    def colours(self, dark):
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.tell("Emulation.setEmulatedMedia", features=[scheme])

    def js(self, expression, *arguments):
        return self.driver.execute_script(f"return {expression}", *arguments)

    def wait(self, expression, *arguments, seconds=20):
        """The value of an expression as soon as it is true."""
        end = time.monotonic() + seconds
        while not (value := self.js(expression, *arguments)):
            assert time.monotonic() < end, f"{expression} did not come true within {seconds} s"
            time.sleep(0.02)
        return value

    def complaints(self):
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self):
        """Addresses that the page asked for since it was opened."""
        told = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return {
            message["params"]["request"]["url"]
            for message in told
            if message["method"] == "Network.requestWillBeSent"
        }

    def lines(self, place):
        """Names of what is drawn in a chart."""
        return self.js("document.getElementById(arguments[0]).data.map((trace) => trace.name)", place)

    def settle(self):
        """Wait until what was scrolled or drawn is on the screen."""
        drawn = "const done = arguments[0]; requestAnimationFrame(() => setTimeout(done, 50))"
        self.driver.execute_async_script(drawn)

    def place(self, place, curve, point):
        """Where a point of a chart is on the screen, onto which the chart is scrolled."""
        scroll = "scrollIntoView({ block: 'center', behavior: 'instant' })"
        self.js(f"document.getElementById(arguments[0]).{scroll}", place)
        self.settle()
        return self.js(
            """((id, curve, point) => {
              const chart = document.getElementById(id), box = chart.getBoundingClientRect();
              const { xaxis, yaxis } = chart._fullLayout, { x, y } = chart.data[curve];
              const [left, top] = [box.left + xaxis._offset, box.top + yaxis._offset];
              return [left + xaxis.d2p(x[point]), top + yaxis.d2p(y[point])];
            })(...arguments)""",
            place,
            curve,
            point,
        )

    def point_at(self, place, curve, point):
        """Move the mouse to a point of a chart."""
        x, y = self.place(place, curve, point)
        for off in (3, 0):
            self.tell("Input.dispatchMouseEvent", type="mouseMoved", x=x + off, y=y)

    def touch(self, path):
        """A finger from the first place to the last."""
        for i, (x, y) in enumerate(path):
            point = {"x": x, "y": y}
            self.tell(
                "Input.dispatchTouchEvent", type="touchMove" if i else "touchStart", touchPoints=[point]
            )
        self.tell("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def close(self):
        self.driver.quit()
