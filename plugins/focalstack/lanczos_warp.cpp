/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/lanczos_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#if defined(__x86_64__)
#define WITH_WIDE_REGISTERS 1
#define WIDE_REGISTERS __attribute__((target("avx2,fma")))
#else
#define WITH_WIDE_REGISTERS 0
#endif
#define INLINE inline __attribute__((always_inline))

namespace dff {
namespace {

constexpr int taps = 8,
              before = 3;   /* samples of the kernel, and those of them before the one at a position */
constexpr int phases = 128; /* a pixel */

/* What warp_nearly_in_place() takes. */
constexpr double most_turn = 0.02, most_zoom = 0.1, most_perspective = 0.05, most_shift = 0.25;
constexpr int least_side = 32;

/* Pixels of a row that share one position along the column, however much it changes. */
constexpr int shared_pixels = 4;

/* Pixels by which a position may be wrong before the weights along a row are made anew; OpenCV rounds to as
 * much. */
constexpr double stale = 1.0 / 64;

using Weights = std::array<float, taps>;

/* sinc(x) sinc(x / 4), of sum 1. */
std::array<Weights, phases> make_weights()
{
    const auto sinc = [](double x) {
        x *= std::numbers::pi;
        return std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x;
    };
    std::array<Weights, phases> table{};
    for (int phase = 0; phase < phases; phase++) {
        std::array<double, taps> weights{};
        double sum = 0.0;
        for (int k = 0; k < taps; k++) {
            const double x = k - before - static_cast<double>(phase) / phases;
            weights[static_cast<size_t>(k)] = sinc(x) * sinc(x / 4.0);
            sum += weights[static_cast<size_t>(k)];
        }
        for (size_t k = 0; k < taps; k++)
            table[static_cast<size_t>(phase)][k] = static_cast<float>(weights[k] / sum);
    }
    return table;
}

const Weights &weights_of(int phase)
{
    static const std::array<Weights, phases> table = make_weights();
    return table[static_cast<size_t>(phase)];
}

/* A position in 1/phases of a pixel. */
int fixed(double position)
{
    return static_cast<int>(std::floor(position * phases + 0.5));
}

/* mixed[i] = the sum of eight rows at i, weighed. */
template <typename Sample>
INLINE void mix_rows_here(const Sample *const *rows, const Weights &w, float *__restrict mixed, int first,
                          int end)
{
    const Sample *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3], *e = rows[4], *f = rows[5],
                 *g = rows[6], *h = rows[7];
    for (int i = first; i < end; i++)
        mixed[i] = w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i] + w[4] * e[i] + w[5] * f[i] +
                   w[6] * g[i] + w[7] * h[i];
}

/* out[i] = the sum of eight samples from row[i] on, `channels` apart, with weights of their own. */
template <typename Sample>
INLINE void mix_columns_here(const float *row, int channels, const float *const *w, Sample *__restrict out,
                             int first, int end)
{
    const float *a = row, *b = a + channels, *c = b + channels, *d = c + channels, *e = d + channels,
                *f = e + channels, *g = f + channels, *h = g + channels;
    const float *s = w[0], *t = w[1], *u = w[2], *v = w[3], *x = w[4], *y = w[5], *z = w[6], *last = w[7];
    constexpr float largest = std::numeric_limits<Sample>::max();
    for (int i = first; i < end; i++) {
        const float sum = s[i] * a[i] + t[i] * b[i] + u[i] * c[i] + v[i] * d[i] + x[i] * e[i] + y[i] * f[i] +
                          z[i] * g[i] + last[i] * h[i] + 0.5F;
        const float bounded = sum < 0.0F ? 0.0F : sum > largest ? largest : sum;
        out[i] = static_cast<Sample>(static_cast<int>(bounded));
    }
}

#if WITH_WIDE_REGISTERS
template <typename Sample>
WIDE_REGISTERS void mix_rows_wide(const Sample *const *rows, const Weights &w, float *mixed, int first,
                                  int end)
{
    mix_rows_here(rows, w, mixed, first, end);
}

template <typename Sample>
WIDE_REGISTERS void mix_columns_wide(const float *row, int channels, const float *const *w, Sample *out,
                                     int first, int end)
{
    mix_columns_here(row, channels, w, out, first, end);
}

bool has_wide_registers()
{
    static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    return has;
}
#endif

template <typename Sample>
void mix_rows(const Sample *const *rows, const Weights &w, float *mixed, int first, int end)
{
#if WITH_WIDE_REGISTERS
    if (has_wide_registers())
        return mix_rows_wide(rows, w, mixed, first, end);
#endif
    mix_rows_here(rows, w, mixed, first, end);
}

template <typename Sample>
void mix_columns(const float *row, int channels, const float *const *w, Sample *out, int first, int end)
{
#if WITH_WIDE_REGISTERS
    if (has_wide_registers())
        return mix_columns_wide(row, channels, w, out, first, end);
#endif
    mix_columns_here(row, channels, w, out, first, end);
}

/* Rows of the warped picture, one after the other. */
template <typename Sample> class RowWarper {
public:
    RowWarper(const cv::Mat &plane, const cv::Matx33d &matrix)
        : plane_(plane), m_(matrix), channels_(plane.channels()),
          beside_(cvCeil(most_shift * plane.cols) + taps),
          mixed_(static_cast<size_t>((plane.cols + 2 * beside_) * channels_)),
          weights_(static_cast<size_t>(taps * plane.cols * channels_))
    {
        for (int k = 0; k < taps; k++)
            weights_of_tap_[static_cast<size_t>(k)] = weights_.data() + k * plane.cols * channels_;
    }

    void warp(int y, Sample *out)
    {
        mix_along_columns(y);
        extend();
        if (runs_.empty() || is_stale(y))
            weigh_columns(y);
        const float *row = mixed_.data() + beside_ * channels_;
        for (const Run &run : runs_)
            mix_columns(row + run.shift * channels_, channels_, weights_of_tap_.data(), out,
                        run.first * channels_, run.end * channels_);
    }

private:
    /* Pixels of a row that look at the same place beside themselves. */
    struct Run {
        int first, end, shift;
    };

    /* Column of the plane for a pixel of the warped picture. */
    double column_of(double u, double y) const
    {
        return (m_(0, 0) * u + m_(0, 1) * y + m_(0, 2)) / (m_(2, 0) * u + m_(2, 1) * y + m_(2, 2));
    }

    /* Row of the plane for that pixel of row y whose column is `x` there. */
    double row_of(double x, double y) const
    {
        const double u =
            (m_(0, 1) * y + m_(0, 2) - x * (m_(2, 1) * y + m_(2, 2))) / (x * m_(2, 0) - m_(0, 0));
        return (m_(1, 0) * u + m_(1, 1) * y + m_(1, 2)) / (m_(2, 0) * u + m_(2, 1) * y + m_(2, 2));
    }

    /* The mixed row: of each column the samples around the row that belongs there. */
    void mix_along_columns(int y)
    {
        const double slope = (row_of(plane_.cols - 1, y) - row_of(0, y)) / (plane_.cols - 1);
        const double most_pixels =
            std::abs(slope) * plane_.cols * phases < 0.5 ? plane_.cols : 1.0 / (std::abs(slope) * phases);
        const int pixels = std::max(shared_pixels, static_cast<int>(most_pixels));
        float *mixed = mixed_.data() + beside_ * channels_;
        for (int first = 0; first < plane_.cols; first += pixels) {
            const int end = std::min(first + pixels, plane_.cols),
                      at = fixed(row_of((first + end - 1) / 2.0, y));
            const std::array<const Sample *, taps> rows = rows_around(at >> 7);
            mix_rows(rows.data(), weights_of(at & (phases - 1)), mixed, first * channels_, end * channels_);
        }
    }

    std::array<const Sample *, taps> rows_around(int whole) const
    {
        static_assert(phases == 1 << 7);
        const int first = whole - before;
        const bool is_inside = first >= 0 && first + taps <= plane_.rows;
        std::array<const Sample *, taps> rows;
        for (int k = 0; k < taps; k++)
            rows[static_cast<size_t>(k)] = plane_.ptr<Sample>(
                is_inside ? first + k
                          : cv::borderInterpolate(first + k, plane_.rows, cv::BORDER_REFLECT_101));
        return rows;
    }

    /* Mirrors the mixed row at its ends. */
    void extend()
    {
        float *row = mixed_.data() + beside_ * channels_;
        for (int i = 1; i <= beside_; i++) {
            std::copy_n(row + i * channels_, channels_, row - i * channels_);
            std::copy_n(row + (plane_.cols - 1 - i) * channels_, channels_,
                        row + (plane_.cols - 1 + i) * channels_);
        }
    }

    bool is_stale(int y) const
    {
        const auto moved = [&](double u) { return std::abs(column_of(u, y) - column_of(u, weighed_)); };
        return std::max({moved(0), moved(plane_.cols / 2.0), moved(plane_.cols - 1.0)}) > stale;
    }

    void weigh_columns(int y)
    {
        weighed_ = y;
        runs_.clear();
        for (int u = 0; u < plane_.cols; u++) {
            const int at = fixed(column_of(u, y)), shift = (at >> 7) - before - u;
            if (runs_.empty() || runs_.back().shift != shift)
                runs_.push_back({u, u, shift});
            runs_.back().end = u + 1;
            const Weights &weights = weights_of(at & (phases - 1));
            for (size_t k = 0; k < taps; k++)
                std::fill_n(weights_of_tap_[k] + u * channels_, channels_, weights[k]);
        }
    }

    const cv::Mat &plane_;
    cv::Matx33d m_;
    int channels_;
    int beside_; /* columns of room at both ends of the mixed row */
    std::vector<float> mixed_;
    std::vector<float> weights_; /* [tap][sample] */
    std::array<float *, taps> weights_of_tap_{};
    std::vector<Run> runs_;
    int weighed_ = 0; /* the row that the weights are for */
};

template <typename Sample> void warp_rows(const cv::Mat &plane, cv::Mat &warped, const cv::Matx33d &matrix)
{
    cv::parallel_for_(
        {0, plane.rows},
        [&](const cv::Range &rows) {
            RowWarper<Sample> warper(plane, matrix);
            for (int y = rows.start; y < rows.end; y++)
                warper.warp(y, warped.ptr<Sample>(y));
        },
        cv::getNumThreads());
}

bool is_nearly_in_place(const cv::Matx33d &m, cv::Size size)
{
    const double x = size.width - 1, y = size.height - 1;
    if (std::abs(m(2, 2) - 1.0) > 0.5 || std::abs(m(2, 0) * x) + std::abs(m(2, 1) * y) > most_perspective)
        return false;
    const cv::Matx33d n = m * (1.0 / m(2, 2));
    if (std::max(std::abs(n(0, 1)), std::abs(n(1, 0))) > most_turn ||
        std::max(std::abs(n(0, 0) - 1.0), std::abs(n(1, 1) - 1.0)) > most_zoom)
        return false;
    for (const cv::Vec2d &corner : {cv::Vec2d{0, 0}, {x, 0}, {0, y}, {x, y}}) {
        const cv::Vec3d image = n * cv::Vec3d(corner[0], corner[1], 1.0);
        if (std::abs(image[0] / image[2] - corner[0]) > most_shift * x ||
            std::abs(image[1] / image[2] - corner[1]) > most_shift * y)
            return false;
    }
    return true;
}

} // namespace

bool warp_nearly_in_place(const cv::Mat &plane, cv::Mat &warped, const cv::Matx33d &matrix)
{
    if (std::min(plane.cols, plane.rows) < least_side || !is_nearly_in_place(matrix, plane.size()))
        return false;
    switch (plane.depth()) {
    case CV_8U:
        warp_rows<uchar>(plane, warped, matrix);
        return true;
    case CV_16U:
        warp_rows<ushort>(plane, warped, matrix);
        return true;
    default:
        return false;
    }
}

} // namespace dff
