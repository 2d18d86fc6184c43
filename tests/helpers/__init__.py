"""What tests share: strategies, oracles, makers of input, readers of files, and the fuzz."""
