"""How far from optimal? A proved bracket of K*, and bounds for the maps of others: 05_certificate.png."""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import beltrami as bt


def main(folder: Path) -> None:
    surface = bt.Surface(bt.rectangle(1, 1, 12, 12))
    boundary = bt.boundary_to_rectangle(surface, 1, 1, corners=(0, 12, 168, 156))
    constraints = bt.Constraints(boundary).pin(6 + 13 * 6, 0.6 + 0.5j)
    proof = bt.certify(surface, constraints, gap=0.05)
    print(proof, proof.reason)
    methods = {"extremal": proof.result.K_max}
    for name in ("harmonic", "mips", "arap"):
        other = getattr(bt, f"{name}_baseline")(surface, constraints.prescribed)
        methods[name] = other.K_max
    figure, axes = plt.subplots(figsize=(6, 4))
    axes.bar(list(methods), list(methods.values()), color="steelblue")
    axes.axhspan(proof.K_lower, min(proof.K_upper, max(methods.values())), color="orange", alpha=0.5, label="K* lies here")
    axes.set_ylabel("K of the worst face")
    axes.legend()
    figure.savefig(folder / "05_certificate.png", dpi=90)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
