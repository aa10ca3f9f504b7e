"""The headless browser has WebGPU, which the tests of this folder need."""

from web.browser import Browser, Serve


def test_it_has_webgpu_on_the_cpu(browser: Browser, serve: Serve) -> None:
    page = browser.page(serve({"index.html": b"<!doctype html><title>empty</title>"}))
    assert page.evaluate("navigator.gpu.requestAdapter().then((adapter) => adapter.info.architecture)") == "swiftshader"
    page.close()
