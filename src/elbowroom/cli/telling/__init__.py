"""How commands speak: results, progress, languages."""
