"""Import of workbooks and CSV files in any layout: proposed tables, columns, units, tools and sites."""
