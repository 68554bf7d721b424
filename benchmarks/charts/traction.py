"""Shear stress in partial slip at 1000 radii, error against time: `make chart-traction`."""

import trade

if __name__ == "__main__":
    trade.chart("traction")
