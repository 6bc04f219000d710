"""Reads lines of a name, a tab and the path of a report of `bandlimit audit --json`; prints a table in Markdown."""

import json
import sys

HEAD = ["program", "shrinks by", "grows by", "shift, px: 1/2, 2", "light", "alpha", "borders", "codes", "alias, dB: 1/2, 37/100"]


def kernel(scale):
    k = scale["x"]["kernel"]
    text = k["name"] + (" (equal weights)" if k["equal_weights"] else "")
    if not k["widened"] and k["name"] != "nearest":
        text += ", **not widened**"
    elif abs(k["widening"] - 1) > 0.02:
        text += f", {k['widening']:.2f} wide"
    if k["residual"] > 0.2:
        return "unknown"
    if not k["known"]:
        return f"unknown (near {k['name']}, {100 * k['residual']:.0f} %)"
    return f"about {text}" if k["residual"] > max(0.015, 2 * k["noise"]) else text


def kernels(scales):
    texts = []
    for scale in scales:
        if kernel(scale) not in texts:
            texts.append(kernel(scale))
    return "; ".join(texts)


def shift(scale):
    axis = max(scale["x"], scale["y"], key=lambda a: abs(a["shift"]))
    if not axis["kernel"]["known"]:
        return "–"
    if axis["alignment"] == "centers":
        return "**centers**"
    if abs(axis["shift"]) < 0.02:
        return "0"
    return f"**{axis['shift']:+.2f}**"


def light(report):
    word = {"srgb": "light", "codes": "codes", "gamma-2.2": "power 2.2", "bt709": "BT.709", "unknown": "–"}[report["filtered_in"]]
    return f"{word}, {255 * report['light'][0]['checkerboard']:.0f}"


def alpha(report):
    if not report["alpha"]:
        return "untested"
    modes = {a["mode"] for a in report["alpha"]}
    leak = max(a["leak"] for a in report["alpha"])
    texts = {"weighted": "weighted", "bleeds": f"**bleeds {255 * leak:.0f}**", "dropped": "dropped", "failed": "fails"}
    hidden = sorted({a["hidden_color"] for a in report["alpha"] if a["mode"] in ("weighted", "bleeds")})
    return " / ".join(texts[m] for m in sorted(modes)) + (f", hidden {' / '.join(hidden)}" if hidden else "")


def codes(report):
    texts = []
    if report["bias"] is not None:
        texts.append(f"{report['bias']:+.2f}")
    phases = [s[a]["phases"] for s in report["scales"] for a in "xy" if s[a]["phases"]]
    if phases:
        texts.append(f"{max(phases)} phases")
    change = 255 * max(l["constants_change"] for l in report["light"])
    if change > 0.6:
        texts.append(f"greys change by {change:.0f}")
    if 255 * report["channel_spread"] > 0.6:
        texts.append(f"coloured by {255 * report['channel_spread']:.0f}")
    return ", ".join(texts)


def row(name, report):
    scales = report["scales"]
    small = [s for s in scales if s["zone_plate"] and eval_ratio(s["scale"]) < 1]
    large = [s for s in scales if eval_ratio(s["scale"]) >= 1]
    return [
        name,
        kernels(small),
        kernels(large),
        f"{shift(small[0])}, {shift(large[0])}",
        light(report),
        alpha(report),
        " or ".join(report["edges"]) or "–",
        codes(report),
        ", ".join(f"{s['zone_plate']['alias_db']:.1f}" for s in small),
    ]


def eval_ratio(text):
    to, source = text.split("/")
    return int(to) / int(source)


def main():
    print("| " + " | ".join(HEAD) + " |\n|" + " --- |" * len(HEAD))
    for line in sys.stdin:
        name, path = line.rstrip("\n").split("\t")
        with open(path) as file:
            print("| " + " | ".join(row(name, json.load(file))) + " |", flush=True)


main()
