"""Over the wire: message schema, live sessions and the web application."""
