/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/noise_excess.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace dff {

namespace {

constexpr int box = 3;          /* differences are averaged over box x box pixels */
constexpr float sigmas = 3.5F;  /* of that average are noise */
constexpr int most_sweeps = 16; /* that are averaged */
constexpr int run = 32;         /* pixels that are looked at together */

/* By how much more noise is allowed where the mean of k sweeps is compared. */
std::array<float, most_sweeps + 1> factors_of_sweeps()
{
    std::array<float, most_sweeps + 1> factors{};
    for (size_t k = 0; k < factors.size(); k++)
        factors[k] =
            sigmas / static_cast<float>(box) * std::sqrt(1.0F + 1.0F / std::max(static_cast<float>(k), 1.0F));
    return factors;
}

const std::array<float, most_sweeps + 1> of_sweeps = factors_of_sweeps();

/* A line below the noise at all brightnesses: what does not rise above it need not be looked at closely. */
struct Line {
    float at_black, slope;
};

Line line_below(const std::array<float, 256> &noise)
{
    const float slope = (noise.back() - noise.front()) / 255.0F;
    float least = noise.front();
    for (size_t i = 0; i < noise.size(); i++)
        for (const size_t end : {i, i + 1})
            least = std::min(least, noise[i] - slope * static_cast<float>(end));
    return {least, slope};
}

/* Mirrored without its edge, as OpenCV's filters see the border. */
int inside(int at, int length)
{
    if (length == 1)
        return 0;
    return at < 0 ? -at : at >= length ? 2 * length - 2 - at : at;
}

/* The differences of the rows that a row's means are made of, for the pixels of `where` and one on each side:
 * each row's are found once. */
class DifferenceRows {
public:
    DifferenceRows(const ComparedChannel &channel, const cv::Rect &where) : channel_(channel), where_(where)
    {
        for (std::vector<float> &row : rows_)
            row.resize(static_cast<size_t>(where.width) + 2);
        subtract(where.y - 1);
        subtract(where.y);
    }

    /* Sums over three rows. After those of row y - 1, or of where.y first. */
    void sum_around(int y, std::vector<float> &sums)
    {
        subtract(y + 1);
        const float *above = row(y - 1).data(), *here = row(y).data(), *below = row(y + 1).data();
        for (size_t x = 0; x < sums.size(); x++)
            sums[x] = above[x] + here[x] + below[x];
    }

private:
    std::vector<float> &row(int y)
    {
        return rows_[static_cast<size_t>(inside(y, channel_.picture.rows) % box)];
    }

    void subtract(int y)
    {
        const int at = inside(y, channel_.picture.rows), cols = channel_.picture.cols;
        const float *picture = channel_.picture[at], *before = channel_.before[at];
        const int first = std::max(where_.x - 1, 0), end = std::min(where_.x + where_.width + 1, cols);
        float *difference = row(y).data() + 1 - where_.x;
        for (int x = first; x < end; x++)
            difference[x] = picture[x] - before[x];
        if (where_.x == 0)
            difference[-1] = difference[inside(-1, cols)];
        if (end == where_.x + where_.width)
            difference[end] = difference[inside(cols, cols)];
    }

    const ComparedChannel &channel_;
    const cv::Rect where_;
    std::array<std::vector<float>, box> rows_; /* row y is the one of y modulo 3 */
};

} // namespace

cv::Rect mark_excess(const ComparedChannel &channel, const cv::Mat1b *sweeps, float margin,
                     const cv::Rect &where, cv::Mat1b &mask)
{
    constexpr float ninth = 1.0F / (box * box);
    const float least_factor = sweeps ? of_sweeps.back() : of_sweeps[1];
    const Line line = line_below(channel.noise);
    const float at_black = line.at_black * least_factor + margin, slope = line.slope * least_factor;
    DifferenceRows rows(channel, where);
    std::vector<float> sums(static_cast<size_t>(where.width) + 2), means(static_cast<size_t>(where.width));
    int left = where.x + where.width, right = where.x, top = where.y + where.height, bottom = where.y;
    for (int y = where.y; y < where.y + where.height; y++) {
        rows.sum_around(y, sums);
        for (size_t x = 0; x < means.size(); x++)
            means[x] = std::fabs(sums[x] + sums[x + 1] + sums[x + 2]) * ninth;
        const float *before = channel.before[y] + where.x;
        for (int first = 0; first < where.width; first += run) {
            const int end = std::min(first + run, where.width);
            int is_any = 0;
            for (int x = first; x < end; x++)
                is_any |= means[static_cast<size_t>(x)] > at_black + slope * before[x];
            for (int x = first; is_any && x < end; x++) {
                const size_t brightness = static_cast<size_t>(std::clamp(before[x], 0.0F, 255.0F));
                const size_t k = sweeps ? (*sweeps)(y, where.x + x) : 1;
                if (means[static_cast<size_t>(x)] - channel.noise[brightness] * of_sweeps[k] <= margin)
                    continue;
                mask(y, where.x + x) = 1;
                left = std::min(left, where.x + x);
                right = std::max(right, where.x + x + 1);
                top = std::min(top, y);
                bottom = std::max(bottom, y + 1);
            }
        }
    }
    return left < right ? cv::Rect(left, top, right - left, bottom - top) : cv::Rect();
}

} // namespace dff
