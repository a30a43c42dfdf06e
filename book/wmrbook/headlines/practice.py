"""Headlines of chapters 10 to 12 and of the README: the audit, real parts, logs and routes."""
