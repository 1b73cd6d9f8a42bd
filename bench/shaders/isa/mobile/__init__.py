"""GPUs of phones and small boards: Mesa's drivers for them, which a user builds, and what their listings hold."""
