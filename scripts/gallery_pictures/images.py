"""Pixels to files: few colours, so that files are small."""

from PIL import Image


def indexed(pixels, colours, dither):
    return Image.fromarray(pixels).quantize(colours, method=Image.Quantize.MEDIANCUT, dither=dither)


def save_picture(pixels, file):
    """`pixels`: rows × columns × 3, bytes."""
    indexed(pixels, 256, Image.Dither.FLOYDSTEINBERG).save(file, optimize=True)


def save_animation(frames, file, milliseconds=60):
    first, *others = [indexed(pixels, 64, Image.Dither.NONE) for pixels in frames]
    first.save(file, save_all=True, append_images=others, duration=milliseconds, loop=0, optimize=True)
