"""The course as a folder of pages that open without castray, without a server and without a network."""

from viewer.site.build import build

__all__ = ["build"]
