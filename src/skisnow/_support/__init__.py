"""What every package uses: files, texts, errors, units, processes; it knows no snow and no ski."""
