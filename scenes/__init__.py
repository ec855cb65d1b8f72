"""Scene files that come with castray; open one by its bare name."""
