"""The options of commands that show the page."""

from typing import Annotated

import typer

Host = Annotated[str, typer.Option(help="Address to listen on; 0.0.0.0 lets other machines in.")]
Port = Annotated[int, typer.Option(help="Port of the page; the next free one if busy, 0: any.")]
OpenPage = Annotated[bool, typer.Option("--open/--no-open", help="Open a browser, where there is one.")]
