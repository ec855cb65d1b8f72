"""What is taken along from the viewer: pictures, paths, and pages that need nothing but themselves."""
