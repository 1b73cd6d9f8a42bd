"""Features that Linux, macOS and Windows each have in their own way, behind one interface.

No other module of `bench` names any of them.
"""
