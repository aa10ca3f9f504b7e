"""Poses and expressions that another program sends while they happen: the VMC protocol, OSC over UDP.

https://protocol.vmc.info/english; VSeeFace, XR Animator, Warudo and applications of phones speak it.
"""
