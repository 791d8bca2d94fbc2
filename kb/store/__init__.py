"""Where statements are kept, and how they are read, written and asked."""
