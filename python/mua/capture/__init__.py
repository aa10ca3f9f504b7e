"""Captures: calibrated pictures of a person, with a rigged template and its poses, in a folder with a capture.json."""

from mua.capture.capture import Capture, CaptureCamera, CaptureClip
from mua.capture.read import open_capture
from mua.capture.write import write_capture

__all__ = ["Capture", "CaptureCamera", "CaptureClip", "open_capture", "write_capture"]
