"""Files of users: plain bytes, TOML, JSON and workbooks, each within limits, every refusal in words.

All TOML and JSON of users is read here and nowhere else: campaigns, scenarios, skis, studies, results, design files.
"""
