# SPDX-License-Identifier: MIT
"""Error of an image against the converged one: the metrics of render/image/image_error.h, for images [height, width, 4] of bytes, red,
green, blue over black and alpha."""
import numpy as np
from scipy import ndimage

DISC = np.hypot(*np.mgrid[-3:4, -3:4]) <= 3
THIN, LEAST = 8, 20  # 1/255, pixels


def covered(a, b):
    return (a[..., 3] > 0) | (b[..., 3] > 0)


def rmse(a, b):
    where = covered(a, b)
    if not where.any():
        return 0.
    return float(np.sqrt(((a[where][:, :3].astype(float) - b[where][:, :3]) ** 2).mean()))


def top_hat(picture):
    bright = picture[..., :3].sum(-1).astype(np.float32) / np.float32(3)  # as in image_error.h: differences of exactly THIN are common
    least = ndimage.grey_erosion(bright, footprint=DISC, mode="constant", cval=np.inf)
    return bright - ndimage.grey_dilation(least, footprint=DISC, mode="constant", cval=-np.inf)


def picture_error(picture, converged):
    where = covered(picture, converged)
    out = {"rmse": rmse(picture, converged), "p999": 0., "covered": float(where.mean()), "thin_parts": 0, "thin_least": 1., "thin_kept": 1.}
    if where.any():
        largest = np.sort(np.abs(picture[where][:, :3].astype(int) - converged[where][:, :3]).max(-1))
        out["p999"] = float(largest[min(len(largest) - 1, int(.999 * len(largest)))])
    truth, have = top_hat(converged), top_hat(picture)
    labels, count = ndimage.label(truth > THIN, np.ones((3, 3)))
    parts = range(1, count + 1)
    if count:
        pixels = ndimage.sum_labels(np.ones_like(truth), labels, parts)
        whole, kept = ndimage.sum_labels(truth, labels, parts), ndimage.sum_labels(np.minimum(truth, have), labels, parts)
        large = pixels >= LEAST
        if large.any():
            out.update(thin_parts=int(large.sum()), thin_least=float((kept / whole)[large].min()),
                       thin_kept=float(kept[large].sum() / whole[large].sum()))
    return out


def flicker(frames, converged):
    """RMSE of the change of the difference from frame to frame."""
    square = count = 0
    for k in range(1, len(frames)):
        where = covered(frames[k], converged[k]) | covered(frames[k - 1], converged[k - 1])
        now, last = (frames[i][where][:, :3].astype(float) - converged[i][where][:, :3] for i in (k, k - 1))
        square, count = square + ((now - last) ** 2).sum(), count + now.size
    return float(np.sqrt(square / count)) if count else 0.
