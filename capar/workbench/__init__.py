"""The interactive system: captures, reasons, rules and knowledge in one window of the browser."""
