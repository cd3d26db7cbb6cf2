# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the gst-plugins-dff authors
"""A page that one can send to somebody: order, alignment, evenness, depth and the picture, all in one file."""
import base64
import html

import numpy as np

from dff_stack import SOFTWARE, results, video
from dff_stack.sweep import CONTACT

LARGE = 1200  # pixels of the longer side
STYLE = '''body { font: 15px/1.5 sans-serif; margin: 2em auto; max-width: 1240px; padding: 0 1em; color: #222; background: #fff }
h1 { font-size: 1.5em } h2 { font-size: 1.15em; margin-top: 2em } img { max-width: 100%; height: auto; vertical-align: top }
.sheet { display: flex; flex-wrap: wrap; gap: 8px } .sheet figure { margin: 0; width: 160px; font-size: 12px; overflow-wrap: anywhere }
table { border-collapse: collapse; font-size: 13px } td, th { padding: 2px 10px; text-align: right; border-bottom: 1px solid #ddd }
td:first-child, th:first-child { text-align: left } .note { color: #a40 }'''


def fitted(width, height, longest):
    scale = min(1.0, longest / max(width, height))
    return max(1, round(width * scale)), max(1, round(height * scale))


def image(pixels, longest, words):
    """An <img> that holds its own JPEG."""
    pixels = pixels[:, :, :3]
    small = video.shrunk(np.ascontiguousarray(pixels), fitted(pixels.shape[1], pixels.shape[0], longest))
    spec = results.plain_spec(small, words)
    spec['CompressionQuality'] = 85
    data = base64.b64encode(results.encoded(small, spec, 'a.jpg')).decode()
    return f'<img alt="{html.escape(words)}" width="{small.shape[1]}" height="{small.shape[0]}" src="data:image/jpeg;base64,{data}">'


def lies(warp):
    """Shift in pixels, zoom in percent and turn in degrees at the centre."""
    across = np.array([warp[0, 0] - warp[0, 2] * warp[2, 0], warp[1, 0] - warp[1, 2] * warp[2, 0]])
    return warp[0, 2], warp[1, 2], 100 * (np.hypot(*across) - 1), np.degrees(np.arctan2(across[1], across[0]))


def rows(pictures, warps, lumas, shares):
    """A line of the table for each picture."""
    mean = np.mean([luma.mean() for luma in lumas])
    for number, (picture, warp, luma) in enumerate(zip(pictures, warps, lumas), 1):
        dx, dy, zoom, turn = lies(warp)
        yield (f'<tr><td>{number} {html.escape(picture.name)}</td><td>{dx:.1f}</td><td>{dy:.1f}</td><td>{zoom:+.2f}</td>'
               f'<td>{turn:+.2f}</td><td>{100 * (luma.mean() / max(mean, 1e-9) - 1):+.1f}</td><td>{100 * shares[number - 1]:.1f}</td></tr>')


def shares_of(depth, count):
    """Of the pixels whose depth is known: how many are sharp in each picture."""
    known = depth[~np.isnan(depth)]
    counts = np.bincount(np.clip(np.round(known), 0, count - 1).astype(int), minlength=count)
    return counts / max(len(known), 1)


def page(title, said, pictures, warps, lumas, solved, colours, depth_colours, confidence):
    """`said`: lines that were told while the pictures were worked on."""
    sheet = ''.join(f'<figure>{image(luma[:, :, None], CONTACT, picture.name)}<figcaption>{number} {html.escape(picture.name)}</figcaption>'
                    '</figure>' for number, (picture, luma) in enumerate(zip(pictures, lumas), 1))
    notes = ''.join(f'<p class="note">{html.escape(line.strip())}</p>' for line in said)
    table = ''.join(rows(pictures, warps, lumas, shares_of(solved.depth, len(pictures))))
    known = 100 * (1 - np.isnan(solved.depth).mean())
    return f'''<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title><style>{STYLE}</style></head><body>
<h1>{html.escape(title)}</h1><p>{len(pictures)} pictures of {pictures[0].size}, made by {SOFTWARE}.</p>{notes}
<h2>The picture</h2>{image(colours, LARGE, 'everything sharp')}
<h2>Depth</h2><p>Warm is near, black is not known; {known:.1f} % are known.</p>{image(depth_colours, LARGE, 'depth')}
<h2>Confidence</h2><p>White is sure.</p>{image(confidence, LARGE // 2, 'confidence')}
<h2>Order: nearest first</h2><div class="sheet">{sheet}</div>
<h2>Alignment and evenness</h2><p>Where the middle picture lies in each: pixels to the right and down, zoom and turn about the centre; how much
brighter each is than the mean; the share of the picture that is sharp in it.</p>
<table><tr><th>picture</th><th>right</th><th>down</th><th>zoom %</th><th>turn °</th><th>brighter %</th><th>sharp %</th></tr>{table}</table>
</body></html>
'''
