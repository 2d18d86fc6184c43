"""Sweeps: thousands of variants of a design, each made, proved and measured, and the best of them."""
