"""Captures: calibrated images of a person, with a rigged template and its poses, in a folder with a capture.json."""

from mua.capture.camera import CaptureCamera
from mua.capture.capture import Capture, CaptureClip
from mua.capture.read import open_capture
from mua.capture.view import View
from mua.capture.write import write_capture

__all__ = ["Capture", "CaptureCamera", "CaptureClip", "View", "open_capture", "write_capture"]
