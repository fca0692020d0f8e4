"""Writes the stock avatar: a VRM 1.0 figure sculpted from distance fields.

Run from the repository root: ``PYTHONPATH=tools:src python -m make_stock_avatar [OUT]``. The same source gives the
same bytes. The avatar's capsules are written beside it, fitted as loading would fit them; they are to be written again
when the fit has changed.

Reading order: `rest` (joints), `fields` and `loft` (clay), `polygonise` and `simplify` (clay to mesh), then the parts
of the figure (`clothes`, `hand`, `head`, `hair`, `eyes`, `features`), `weights` (skin), `shading`, `palette` and
`about`, and last `assemble` and `vrm` (the file).
"""
