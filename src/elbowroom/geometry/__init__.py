"""Rotations, rigid transforms and primitives: right-handed, Y up, quaternions `xyzw`, metres and radians."""
