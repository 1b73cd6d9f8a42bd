"""Features that Linux, macOS and Windows implement differently, behind one interface.

No other module in `bench` names any of these systems.
"""
