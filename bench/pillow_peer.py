"""Pillow, or Pillow-SIMD, as bench/README.md asks a program to answer."""
import os
import sys
import time

# Freed pictures are kept for the next run, so that no run pays for fresh memory.
os.environ.setdefault("PILLOW_BLOCKS_MAX", "64")
os.environ.setdefault("PILLOW_BLOCK_SIZE", "16m")

import PIL
from PIL import Image


def hello():
    simd = ".post" in PIL.__version__
    name = ("Pillow-SIMD " if simd else "Pillow ") + PIL.__version__
    note = ("mode RGBX, which treats all channels alike; box is Image.reduce(2); its result is a new picture each time, "
            "of kept memory; no threads, no linear light")
    return f"{name}\t1\t{note}"


class Work:
    def __init__(self, width, height, new_width, new_height, samples, kernel, chain, light, threads, copies, path):
        self.sizes = [(int(new_width), int(new_height))]
        while chain == "chain" and self.sizes[-1] != (1, 1):
            self.sizes.append(tuple(max(1, n // 2) for n in self.sizes[-1]))
        self.kernel = kernel
        self.answer = "none" if light == "linear" else "ready"
        if self.answer == "none":
            return
        with open(path, "rb") as file:
            data = file.read()
        size = (int(width), int(height))
        mode, raw = ("F", "F;32F") if samples == "f32" else ("RGBX", "RGBX")
        self.sources = [Image.frombytes(mode, size, data, "raw", raw) for _ in range(int(copies))]
        self.results = [None] * int(copies)

    def run(self, k):
        self.results[k] = None
        start = time.perf_counter()
        image, levels = self.sources[k], []
        for size in self.sizes:
            # reduce() rounds sizes up where resize() would round down: only even ones are the same thing.
            if self.kernel == "box" and image.width % 2 == 0 and image.height % 2 == 0:
                image = image.reduce(2)
            else:
                image = image.resize(size, Image.Resampling.BOX if self.kernel == "box" else Image.Resampling.LANCZOS)
            levels.append(image)
        seconds = time.perf_counter() - start
        self.results[k] = levels
        return seconds

    def save(self, k, path):
        with open(path, "wb") as file:
            for image in self.results[k]:
                file.write(image.tobytes())


def main():
    work = None
    for line in sys.stdin:
        words = line.split()
        if words[0] == "hello":
            answer = hello()
        elif words[0] == "prepare":
            work = Work(*words[1:])
            answer = work.answer
        elif words[0] == "run":
            answer = repr(work.run(int(words[1])))
        else:
            work.save(int(words[1]), words[2])
            answer = "saved"
        print(answer, flush=True)


main()
