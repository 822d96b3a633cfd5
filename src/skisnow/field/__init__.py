"""Field campaigns: records, files, screening, store, reference campaign."""
