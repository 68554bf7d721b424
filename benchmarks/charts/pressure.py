"""Pressure at 1000 radii, error against time: `make chart-pressure`."""

import trade

if __name__ == "__main__":
    trade.chart("pressure")
