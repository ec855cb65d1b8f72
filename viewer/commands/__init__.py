"""The commands of `castray`, one a module, which is imported when its command is run."""
