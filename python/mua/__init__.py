"""MUA: an open pipeline and player for photoreal, animatable human avatars."""

__version__ = "0.1.0"
