"""The messages of a live session, by what they are about; `server.wire.messages` says which travel in which direction.

Field names travel in camelCase. Units: metres, radians, seconds unless a name says otherwise; quaternions xyzw. A field
that is None says "unchanged" in a client's message and "nothing to tell" in a server's.
"""
