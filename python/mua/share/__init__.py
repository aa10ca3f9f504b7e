"""An avatar in a browser: served from this machine, written as a folder for a web host, or as one HTML file."""
