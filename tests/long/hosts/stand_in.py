#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Stand-ins for hosts whose exported text cannot run by itself here: the documented loop of the host, with the
numbers of the text, from the pinned start to the end that the text names.

usage: stand_in.py HOST FILE, for the hosts chroma, tmlqcd, openqcd, ordinarydiffeq and julia
"""
import math
import re
import sys


def numbers_after(text, mark):
    found = re.search(re.escape(mark) + r"\s*=?\s*\(([^)]*)\)", text)
    return [float(one) for one in found.group(1).split(",") if one.strip()]


def force(q):
    return [-q[0] - 2 * q[0] * q[1], -q[1] - q[0] ** 2 + q[1] ** 2]


class state:
    def __init__(self):
        self.q, self.p = [0.3, 0.2], [0.1, -0.25]

    def kick(self, c):
        self.p = [p + c * f for p, f in zip(self.p, force(self.q))]

    def drift(self, c):
        self.q = [self.q[0] + c * self.p[0], self.q[1] + c * 0.5 * self.p[1]]


def second_order_minimum_norm(x, lam, n, length):
    """What Chroma, tmLQCD and openQCD make of lambda: kicks of neighbouring steps are one."""
    h = length / n
    x.kick(lam * h)
    for i in range(n):
        x.drift(h / 2)
        x.kick((1 - 2 * lam) * h)
        x.drift(h / 2)
        x.kick(lam * h * (2 if i < n - 1 else 1))


def ordinarydiffeq(x, a, b, n, length):
    """The stages of perform_step! for a SymplecticTableau."""
    dt = length / n
    for _ in range(n):
        for i in range(len(a)):
            x.drift(b[i] * dt)
            x.kick(a[i] * dt)


def julia(x, text):
    """apply! over the words of the module, in place of Julia: the numbers are tried, and the language is not."""
    drawn = 0

    def word(name):
        letters, numbers = re.search(rf'const {name} = \("([A-Z]*)", \[([^]]*)\]\)', text).groups()
        return letters, [float(one) for one in numbers.split(",")]

    def apply(name):
        nonlocal drawn
        letters, c = word(name)
        c = iter(c)
        for letter in letters:
            if letter == "A":
                x.drift(next(c) * 0.1)
            elif letter == "B":
                x.kick(next(c) * 0.1)
            elif letter == "D":
                b, f = next(c), force(x.q)
                shift = next(c) * 0.01
                there = [x.q[0] + shift * f[0], x.q[1] + shift * 0.5 * f[1]]
                x.p = [p + b * 0.1 * g for p, g in zip(x.p, force(there))]
            else:
                decay = math.exp(-1.5 * next(c) * 0.1)
                spread = math.sqrt((1 - decay**2) * 0.7)
                x.p = [decay * x.p[0] + spread * math.sin(drawn + 1),
                       decay * x.p[1] + spread * math.sqrt(2) * math.sin(drawn + 2)]
                drawn += 2

    apply("START")
    for _ in range(10):
        apply("KERNEL")
    apply("FINISH")


def main():
    host, file = sys.argv[1:]
    text = open(file).read()
    x = state()
    if host in ("ordinarydiffeq", "julia"):
        if host == "julia":
            julia(x, text)
        else:
            ordinarydiffeq(x, numbers_after(text, "const a"), numbers_after(text, "const b"), 10, 1.0)
        end_q, end_p = (
            [float(one) for one in re.search(re.escape(f"{name} - [") + "([^]]*)", text).group(1).split(",")]
            for name in ("q", "p"))
    else:
        patterns = {"chroma": r"<lambda>(.*)</lambda>", "tmlqcd": r"Lambda0 = (.*)", "openqcd": r"lambda +(.*)"}
        lam = float(re.search("(?m)^ *" + patterns[host], text).group(1))
        second_order_minimum_norm(x, lam, 10, 1.0)
        end_q, end_p = numbers_after(text, "to q"), numbers_after(text[text.index("to q"):], "p")
    off = max(abs(u - v) for u, v in zip(x.q + x.p, end_q + end_p))
    print(f"{host}: off by {off:.1e}")
    return not off < 1e-13  # some hundred roundings of numbers below 1


if __name__ == "__main__":
    sys.exit(main())
