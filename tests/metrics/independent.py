#!/usr/bin/env python3
"""The numbers that metrics tests compare with, computed apart from the program.

MSE, PSNR and SSIM come from scikit-image; FLIP is written down from the papers' equations
[Andersson et al. 2020, 2021] with two-dimensional kernels in double precision, relMSE and MAPE from
their definitions in docs/metrics.md. Needs numpy, scipy and scikit-image (numbers in the tests:
1.24.2, 1.10.1, 0.19.3). Prints one line a number, and writes flip_maps.json, a small pair of
pictures with its maps of FLIP, into the folder given as argument.
"""
import json
import os
import sys

import numpy as np
from scipy.ndimage import correlate
from skimage.metrics import mean_squared_error, peak_signal_noise_ratio, structural_similarity

W, H = 61, 47


def pictures():
    """Reference and test of tests/metrics/patterns.h: whole numbers 0..255, H x W x 3."""
    y, x, c = np.meshgrid(np.arange(H), np.arange(W), np.arange(3), indexing="ij")
    reference = 20 + 3 * x // 2 + y + 15 * c + 60 * ((x // 8 + y // 8) % 2)
    h = ((y * W + x) * 3 + c).astype(np.uint64)
    h = (h * 2654435761 + 12345) & 0xFFFFFFFF
    h ^= h >> 15
    h = (h * 2246822519) & 0xFFFFFFFF
    h ^= h >> 13
    noise = (h % 41).astype(np.int64) - 20
    shadow = np.where((x > 30) & (y > 20) & (x < 45), 25, 0)
    return reference, np.clip(reference + noise - shadow, 0, 255)


def colorful_pictures():
    """Reference and test, whole numbers 0..255, H x W x 3: what the pattern above lacks. All corners
    of the colour cube, next to each other and swapped; lines and dots that appear, vanish and move;
    a ramp down to black; equal pixels."""
    width, height = 29, 22
    y, x = np.meshgrid(np.arange(height), np.arange(width), indexing="ij")
    corner = (x // 4 + 3 * (y // 4)) % 8
    reference = np.stack([255 * (corner >> k & 1) for k in range(3)], -1)
    reference[12:] = (5 * x + 2 * (y - 12))[12:, :, None] * np.array([100, 60, 20]) // 100
    test = reference.copy()
    test[0:4, 0:4], test[0:4, 4:8] = reference[0, 4], reference[0, 0]
    test[4:12, 8:20] = reference[4:12, 8:20, [1, 2, 0]]
    test[18, 3:27] = 255 - test[18, 3:27]
    reference[10, 4], test[10, 6] = 90, 90
    reference[6:16, 24], test[6:16, 25] = (255, 240, 10), (255, 240, 10)
    test[12:16, 0:12] = test[12:16, 0:12] * 3 // 4 + 20
    return reference, test


def radiance(v):
    return (v.astype(float)**4 / 2**24).astype(np.float32).astype(float)


# ---------------------------------------------------------------- FLIP
M = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
              [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
              [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = M @ np.ones(3)
PPD = 0.7 * 3840 / 0.7 * np.pi / 180


def ycxcz(linear):
    x, y, z = np.moveaxis(linear @ M.T / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def linear_of_ycxcz(t):
    y = (t[..., 0] + 16) / 116
    xyz = np.stack([y + t[..., 1] / 500, y, y - t[..., 2] / 200], -1) * WHITE
    return xyz @ np.linalg.inv(M).T


def hunt_lab(linear):
    t = linear @ M.T / WHITE
    d = 6 / 29
    f = np.where(t > d**3, np.cbrt(t), t / (3 * d * d) + 4 / 29)
    lightness = 116 * f[..., 1] - 16
    a, b = 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])
    return np.stack([lightness, 0.01 * lightness * a, 0.01 * lightness * b], -1)


def hyab(p, q):
    d = p - q
    return np.abs(d[..., 0]) + np.sqrt(d[..., 1]**2 + d[..., 2]**2)


def csf_kernel(a1, b1, a2, b2, ppd):
    r = int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi**2)) * ppd))
    i, j = np.meshgrid(np.arange(-r, r + 1), np.arange(-r, r + 1))
    z = (i**2 + j**2) / ppd**2
    g = (a1 * np.sqrt(np.pi / b1) * np.exp(-np.pi**2 * z / b1)
         + a2 * np.sqrt(np.pi / b2) * np.exp(-np.pi**2 * z / b2))
    return g / g.sum()


def filtered(linear, ppd):
    kernels = [csf_kernel(1, 0.0047, 0, 1e-5, ppd), csf_kernel(1, 0.0053, 0, 1e-5, ppd),
               csf_kernel(34.1, 0.04, 13.5, 0.025, ppd)]
    t = ycxcz(linear)
    t = np.stack([correlate(t[..., k], kernels[k], mode="nearest") for k in range(3)], -1)
    return hunt_lab(np.clip(linear_of_ycxcz(t), 0, 1))


def features(linear, ppd):
    y = (ycxcz(linear)[..., 0] + 16) / 116
    sd = 0.5 * 0.082 * ppd
    r = int(np.ceil(3 * sd))
    i, j = np.meshgrid(np.arange(-r, r + 1), np.arange(-r, r + 1))
    g = np.exp(-(i**2 + j**2) / (2 * sd * sd))
    out = []
    for kernel in (-i * g, (i**2 / sd**2 - 1) * g):
        kernel = np.where(kernel < 0, kernel / -kernel[kernel < 0].sum(),
                          kernel / kernel[kernel > 0].sum())
        out.append(np.hypot(correlate(y, kernel, mode="nearest"),
                            correlate(y, kernel.T, mode="nearest")))
    return out


def flip_of_linear(reference, test, ppd=PPD):
    cmax = hyab(hunt_lab(np.array([0., 1, 0])), hunt_lab(np.array([0., 0, 1])))**0.7
    e = hyab(filtered(reference, ppd), filtered(test, ppd))**0.7
    knee = 0.4 * cmax
    color = np.where(e < knee, 0.95 / knee * e, 0.95 + (e - knee) / (cmax - knee) * 0.05)
    (edge_r, point_r), (edge_t, point_t) = features(reference, ppd), features(test, ppd)
    feature = (np.maximum(np.abs(edge_r - edge_t), np.abs(point_r - point_t)) / np.sqrt(2))**0.5
    return color**(1 - feature)


def linear_of_srgb(v):
    return np.where(v > 0.04045, ((v + 0.055) / 1.055)**2.4, v / 12.92)


ACES = (0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14)


def aces(x):
    a, b, c, d, e = ACES
    return np.clip((a * x * x + b * x) / (c * x * x + d * x + e), 0, 1)


def hdr_flip(reference, test):
    a, b, c, d, e = ACES
    white = max(np.roots([a - 0.85 * c, b - 0.85 * d, -0.85 * e]))
    y = reference @ M[1]
    start, stop = np.log2(white / y.max()), np.log2(white / np.median(y))
    n = max(2, int(np.ceil(stop - start)))
    maps = [flip_of_linear(aces(2**ev * reference), aces(2**ev * test))
            for ev in np.linspace(start, stop, n)]
    return np.max(maps, 0), start, stop, n


def write_maps(folder):
    reference, test = colorful_pictures()
    linear = [linear_of_srgb(v / 255.0) for v in (reference, test)]
    hdr, start, stop, n = hdr_flip(radiance(reference), radiance(test))

    def rounded(values):
        return [round(float(v), 7) for v in values.ravel()]
    # Rows from the top.
    maps = {"width": reference.shape[1], "height": reference.shape[0],
            "reference": reference.ravel().tolist(), "test": test.ravel().tolist(),
            "flip": rounded(flip_of_linear(*linear)),
            "flipAt20PixelsPerDegree": rounded(flip_of_linear(*linear, 20)),
            "hdrFlip": rounded(hdr), "hdrStartEv": start, "hdrStopEv": stop, "hdrExposures": n}
    with open(os.path.join(folder, "flip_maps.json"), "w") as file:
        lines = ['"' + key + '": ' + json.dumps(value, separators=(",", ":"))
                 for key, value in maps.items()]
        file.write("{\n" + ",\n".join(lines) + "\n}\n")


def main():
    reference, test = pictures()
    r, t = reference / 255.0, test / 255.0
    print("sums", reference.sum(), test.sum())
    print("display MSE", mean_squared_error(r, t))
    print("PSNR", peak_signal_noise_ratio(r, t, data_range=1))
    luma = np.array([0.2126, 0.7152, 0.0722])
    options = dict(gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1)
    print("SSIM", structural_similarity(r @ luma, t @ luma, **options))
    ldr = flip_of_linear(linear_of_srgb(r), linear_of_srgb(t))
    print("FLIP", ldr.mean(), "at (5, 7)", ldr[7, 5], "at (40, 30)", ldr[30, 40], "corner",
          ldr[0, 0])
    R, T = radiance(reference), radiance(test)
    floor = 1e-2 * R.mean()**2
    print("MSE", mean_squared_error(R, T))
    print("relMSE", ((T - R)**2 / (R * R + floor)).mean())
    print("MAPE", (np.abs(T - R) / (R + 1e-2 * R.mean())).mean())
    yr, yt = R @ luma, T @ luma
    print("leaked", np.maximum(yt - yr, 0).sum() / yr.sum(),
          "occluded", np.maximum(yr - yt, 0).sum() / yr.sum())
    hdr, start, stop, n = hdr_flip(R, T)
    print("HDR-FLIP", hdr.mean(), "from", start, "to", stop, "in", n, "at (40, 30)", hdr[30, 40])
    print("squares of the maps", (ldr**2).mean(), (hdr**2).mean())
    if len(sys.argv) > 1:
        write_maps(sys.argv[1])


if __name__ == "__main__":
    main()
