#!/usr/bin/env python3
"""fuzz/make_image_seeds.py FOLDER: small pictures of many kinds, as other programs write them.

What it made is in fuzz/corpus/image_file, under made_; run it again to add kinds. Needs oiiotool and Pillow.
"""
import os
import subprocess
import sys

from PIL import Image

WIDTH, HEIGHT = 9, 7
CORNERS = "topleft=.1,.9,.2,1:topright=1,.3,.1,.5:bottomleft=0,.5,1,.1:bottomright=.7,.7,0,1"


def oiio(*arguments):
    """A picture of four colours, given to oiiotool with these arguments behind it."""
    subprocess.run(["oiiotool", "--pattern", f"fill:{CORNERS}", f"{WIDTH}x{HEIGHT}", "4", *arguments], check=True)


def rgb(name, *arguments):
    oiio("--ch", "R,G,B", *arguments, "--eraseattrib", "DateTime", "-o", name)


def grey(name, *arguments):
    oiio("--ch", "R", "--chnames", "Y", *arguments, "-o", name)


def rgba(name, *arguments):
    oiio(*arguments, "-o", name)


def with_oiiotool():
    rgb("rgb16.png", "-d", "uint16")
    grey("grey16.png", "-d", "uint16")
    for compression in ("none", "packbits"):
        rgb(f"{compression}.tif", "-d", "uint8", "--compression", compression)
    rgb("planes.tif", "-d", "uint16", "--planarconfig", "separate")
    rgba("float.tif", "-d", "float")
    rgba("half.tif", "-d", "half")
    rgba("double.tif", "-d", "double")
    grey("uint32.tif", "-d", "uint32")
    rgb("pages.tif", "-d", "uint8", "--dup", "--siappend")
    grey("turned.tif", "-d", "uint8", "--attrib", "Orientation", "8")
    for compression in ("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"):
        rgb(f"{compression}.exr", "-d", "half", "--compression", compression)
    rgba("tiles.exr", "-d", "float", "--tile", "16", "16")
    rgba("window.exr", "-d", "half", "--origin", "+3+2", "--fullsize", "20x20+0+0")
    rgb("parts.exr", "-d", "half", "--dup", "--siappend")
    rgba("channels.exr", "-d", "half", "--chnames", "R,G,velocity.x,Z")
    rgb("flat.hdr")
    rgb("runs.hdr", "--resize", "20x3")
    rgb("lossy.webp", "-d", "uint8")
    rgba("rgba.tga", "-d", "uint8")


def with_pillow():
    oiio("-d", "uint8", "-o", "rgba8.png")
    straight = Image.open("rgba8.png")
    straight.load()
    straight.info = {}
    picture = straight.convert("RGB")
    light = picture.convert("L")
    palette = picture.quantize(4)
    bits = picture.convert("1")

    palette.save("palette.png")
    palette.save("palette_alpha.png", transparency=1)
    bits.save("bits.png")
    light.save("grey.png")
    straight.convert("LA").save("grey_alpha.png")

    light.save("grey.jpg")
    picture.save("progressive.jpg", progressive=True, quality=50)
    picture.save("420.jpg", subsampling="4:2:0", quality=50)
    picture.save("422.jpg", subsampling="4:2:2", quality=50)
    picture.convert("CMYK").save("cmyk.jpg", quality=50)
    picture.save("restart.jpg", restart_marker_blocks=1, quality=50)
    picture.save("comment.jpg", comment=b"text", quality=50)
    turned = Image.Exif()
    turned[0x112] = 6
    picture.save("turned.jpg", exif=turned, quality=50)

    for compression in ("tiff_lzw", "tiff_adobe_deflate", "jpeg"):
        picture.save(f"{compression}.tif", compression=compression)
    for compression in ("group3", "group4"):
        bits.save(f"{compression}.tif", compression=compression)
    palette.save("palette.tif")
    picture.convert("CMYK").save("cmyk.tif")
    picture.convert("LAB").save("lab.tif")
    picture.save("big.tif", big_tiff=True)
    straight.save("rgba.tif")

    picture.save("p6.ppm")
    light.save("p5.pgm")
    bits.save("p4.pbm")
    light.convert("I;16").save("p5_16.pgm")
    light.convert("F").save("pf.pfm")

    straight.save("alpha.webp")
    picture.save("lossless.webp", lossless=True)
    straight.save("lossless_alpha.webp", lossless=True)
    picture.save("frames.webp", save_all=True, append_images=[light.convert("RGB")])
    picture.save("turned.webp", exif=turned, lossless=True)

    picture.save("24.bmp")
    palette.save("palette.bmp")
    light.save("grey.bmp")
    bits.save("bits.bmp")
    straight.save("32.bmp")

    for compression in (None, "tga_rle"):
        suffix = "_rle" if compression else ""
        picture.save(f"rgb{suffix}.tga", compression=compression)
        light.save(f"grey{suffix}.tga", compression=compression)
        palette.save(f"palette{suffix}.tga", compression=compression)
    picture.save("downwards.tga", orientation=1)


def by_hand():
    """What neither of them writes."""
    texts = {
        "p1.pbm": "P1\n3 2\n0 1 0\n1 0 1\n",
        "p2.pgm": "P2\n# a comment\n3 2 9\n0 1 2\n3 4 9\n",
        "p3.ppm": "P3 1 2 255 1 2 3 255 0 128\n",
    }
    for name, text in texts.items():
        with open(name, "w", encoding="ascii") as file:
            file.write(text)
    with open("xyze.hdr", "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n+Y 2 +X 1\n" + bytes([128, 64, 32, 129, 1, 2, 3, 128]))
    with open("old_runs.hdr", "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 9\n" + bytes([9, 8, 7, 128, 1, 1, 1, 8]))
    with open("rle.bmp", "wb") as file:
        codes = bytes([3, 1, 0, 0, 2, 0, 1, 1, 0, 1])
        head = (40).to_bytes(4, "little") + (3).to_bytes(4, "little") + (2).to_bytes(4, "little")
        head += bytes([1, 0, 8, 0, 1, 0, 0, 0]) + len(codes).to_bytes(4, "little") + bytes(8) + bytes([2, 0, 0, 0] * 2)
        start = 14 + len(head) + 8
        file.write(b"BM" + (start + len(codes)).to_bytes(4, "little") + bytes(4) + start.to_bytes(4, "little") + head)
        file.write(bytes([9, 8, 7, 0, 1, 2, 3, 0]) + codes)


if __name__ == "__main__":
    os.makedirs(sys.argv[1], exist_ok=True)
    os.chdir(sys.argv[1])
    with_oiiotool()
    with_pillow()
    by_hand()
