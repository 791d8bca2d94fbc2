"""The words that every stage shares: captures, facts and PARs, with nothing below them."""
