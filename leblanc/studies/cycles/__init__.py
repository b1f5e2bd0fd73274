"""Self-excited whirls of finite size."""
