"""What Linux, macOS and Windows have each in their own way, behind one interface.

No other module of `bench` names any of it.
"""
