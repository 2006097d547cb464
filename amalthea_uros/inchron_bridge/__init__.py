"""Systems as INCHRON projects and back; the only room that knows both.

What a project has no class or feature for is kept in the comment of the object, so that a project that is read again means the same.
"""
