/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/lanczos_warp.h"

#include <algorithm>
#include <array>
#include <bit>
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

/* Pixels of a row with the same position along the column, from which on their weights are not looked up one
 * by one. */
constexpr int level_pixels = 32;

/* Pixels by which a position may be wrong before the weights along a row are made anew; OpenCV rounds to as
 * much. */
constexpr double stale = 1.0 / 64;

/* The kernel's weights at each of the places between two pixels. */
using Table = std::array<float, size_t{phases} * taps>;

/* sinc(x) sinc(x / 4), of sum 1. */
Table make_table()
{
    const auto sinc = [](double x) {
        x *= std::numbers::pi;
        return std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x;
    };
    Table table{};
    for (int phase = 0; phase < phases; phase++) {
        std::array<double, taps> weights{};
        double sum = 0.0;
        for (int k = 0; k < taps; k++) {
            const double x = k - before - static_cast<double>(phase) / phases;
            weights[static_cast<size_t>(k)] = sinc(x) * sinc(x / 4.0);
            sum += weights[static_cast<size_t>(k)];
        }
        for (size_t k = 0; k < taps; k++)
            table[static_cast<size_t>(phase * taps) + k] = static_cast<float>(weights[k] / sum);
    }
    return table;
}

const Table &table_of_weights()
{
    static const Table table = make_table();
    return table;
}

/* A position that changes along a row: (a + b u) / (c + d u). */
struct Ratio {
    double a, b, c, d;

    INLINE double at(double u) const { return (a + b * u) / (c + d * u); }
};

/* Positions of pixels `step` apart, in 1/phases of a pixel. */
INLINE void place(const Ratio &ratio, double first, int step, int *__restrict places, int count)
{
    for (int i = 0; i < count; i++)
        places[i] = static_cast<int>(std::floor(ratio.at(first + i * step) * phases + 0.5));
}

/* Weights of each tap for pixels at these places, `samples` for each. */
template <int samples>
INLINE void look_up(const int *places, int count, const float *table, float *const *weights)
{
    for (int i = 0; i < count; i++) {
        const float *found = table + (places[i] & (phases - 1)) * taps;
        for (int k = 0; k < taps; k++)
            for (int j = 0; j < samples; j++)
                weights[k][i * samples + j] = found[k];
    }
}

/* mixed[i] = the sum of eight rows at i, weighed. */
INLINE void mix_rows(const float *const *rows, const float *w, float *__restrict mixed, int first, int end)
{
    const float *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3], *e = rows[4], *f = rows[5],
                *g = rows[6], *h = rows[7];
    const float s = w[0], t = w[1], u = w[2], v = w[3], x = w[4], y = w[5], z = w[6], last = w[7];
    for (int i = first; i < end; i++)
        mixed[i] = s * a[i] + t * b[i] + u * c[i] + v * d[i] + x * e[i] + y * f[i] + z * g[i] + last * h[i];
}

/* The same with weights of their own. */
INLINE void mix_turned_rows(const float *const *rows, const float *const *w, float *__restrict mixed,
                            int first, int end)
{
    const float *a = rows[0], *b = rows[1], *c = rows[2], *d = rows[3], *e = rows[4], *f = rows[5],
                *g = rows[6], *h = rows[7];
    const float *s = w[0], *t = w[1], *u = w[2], *v = w[3], *x = w[4], *y = w[5], *z = w[6], *last = w[7];
    for (int i = first; i < end; i++)
        mixed[i] = s[i] * a[i] + t[i] * b[i] + u[i] * c[i] + v[i] * d[i] + x[i] * e[i] + y[i] * f[i] +
                   z[i] * g[i] + last[i] * h[i];
}

/* out[i] = the sum of eight samples from row[i] on, `channels` apart, with weights of their own. */
template <typename Sample>
INLINE void mix_columns(const float *row, int channels, const float *const *w, Sample *__restrict out,
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

/* Weights of samples of a row, [tap][sample]. */
class RowWeights {
public:
    explicit RowWeights(int samples) : values_(static_cast<size_t>(taps * samples))
    {
        for (int k = 0; k < taps; k++)
            of_tap_[static_cast<size_t>(k)] = values_.data() + k * samples;
    }

    float *const *of_taps() { return of_tap_.data(); }

private:
    std::vector<float> values_;
    std::array<float *, taps> of_tap_{};
};

/* Rows of a plane as float, which are kept while the rows of the warped picture around them are made. */
template <typename Sample> class FloatRows {
public:
    FloatRows(const cv::Mat &plane, int kept)
        : plane_(plane), mask_(static_cast<int>(std::bit_ceil(static_cast<unsigned>(kept))) - 1),
          samples_(plane.cols * plane.channels()),
          values_((static_cast<size_t>(mask_) + 1) * static_cast<size_t>(samples_)),
          rows_(static_cast<size_t>(mask_) + 1, -1)
    {
    }

    /* Mirrored beyond the plane's ends. */
    INLINE const float *at(int row)
    {
        if (row < 0 || row >= plane_.rows)
            row = cv::borderInterpolate(row, plane_.rows, cv::BORDER_REFLECT_101);
        const auto slot = static_cast<size_t>(row & mask_);
        float *__restrict values = values_.data() + slot * static_cast<size_t>(samples_);
        if (rows_[slot] != row) {
            rows_[slot] = row;
            const Sample *samples = plane_.ptr<Sample>(row);
            for (int i = 0; i < samples_; i++)
                values[i] = samples[i];
        }
        return values;
    }

private:
    const cv::Mat &plane_;
    int mask_, samples_;
    std::vector<float> values_;
    std::vector<int> rows_; /* that lie in each slot */
};

/* Rows of the warped picture, one after the other. */
template <typename Sample, int channels> class RowWarper {
public:
    RowWarper(const cv::Mat &plane, const cv::Matx33d &matrix)
        : plane_(plane), m_(matrix), groups_((plane.cols + shared_pixels - 1) / shared_pixels),
          beside_(farthest(matrix, plane.size())),
          mixed_(static_cast<size_t>((plane.cols + 2 * beside_) * channels)),
          rows_of_plane_(plane, rows_across(matrix, plane.size())), places_(static_cast<size_t>(plane.cols)),
          column_weights_(plane.cols * channels), row_weights_(groups_ * shared_pixels * channels),
          table_(table_of_weights().data())
    {
    }

    INLINE void warp(int y, Sample *out)
    {
        mix_along_columns(y);
        extend();
        if (runs_.empty() || is_stale(y))
            weigh_columns(y);
        const float *row = mixed_row();
        for (const Run &run : runs_)
            mix_columns(row + run.shift * channels, channels, column_weights_.of_taps(), out,
                        run.first * channels, run.end * channels);
    }

private:
    /* Pixels of a row that look at the same place beside themselves. */
    struct Run {
        int first, end, shift;
    };

    /* Columns that a row needs beyond its ends: of those of a warp, its corners go farthest. */
    static int farthest(const cv::Matx33d &m, cv::Size size)
    {
        double most = 0.0;
        for (const double x : {0.0, size.width - 1.0})
            for (const double y : {0.0, size.height - 1.0}) {
                const cv::Vec3d image = m * cv::Vec3d(x, y, 1.0);
                most = std::max(most, std::abs(image[0] / image[2] - x));
            }
        return std::min(cvCeil(most) + taps, size.width - 1);
    }

    /* Rows of the plane that a row of a warp crosses, with those around. */
    static int rows_across(const cv::Matx33d &m, cv::Size size)
    {
        double most = 0.0;
        for (const double y : {0.0, size.height - 1.0}) {
            const cv::Vec3d first = m * cv::Vec3d(0.0, y, 1.0),
                            last = m * cv::Vec3d(size.width - 1.0, y, 1.0);
            most = std::max(most, std::abs(last[1] / last[2] - first[1] / first[2]));
        }
        return cvCeil(most) + taps + 2;
    }

    /* Column of the plane for a pixel u of row y of the warped picture. */
    INLINE Ratio columns(double y) const
    {
        return {m_(0, 1) * y + m_(0, 2), m_(0, 0), m_(2, 1) * y + m_(2, 2), m_(2, 0)};
    }

    /* Row of the plane for that pixel of row y whose column is x there. */
    INLINE Ratio rows(double y) const
    {
        const auto [a, b, c, d] = columns(y);
        const double e = m_(1, 1) * y + m_(1, 2);
        return {m_(1, 0) * a - e * b, e * d - m_(1, 0) * c, d * a - c * b, 0.0};
    }

    /* The mixed row: of each column the samples around the row that belongs there. */
    INLINE void mix_along_columns(int y)
    {
        const Ratio ratio = rows(y);
        const double turn = std::abs(ratio.at(plane_.cols) - ratio.at(0)) / plane_.cols;
        if (turn * phases * level_pixels > 1.0)
            return mix_turned(ratio);
        const int pixels = static_cast<int>(std::min<double>(plane_.cols, 1.0 / (turn * phases)));
        for (int first = 0; first < plane_.cols; first += pixels) {
            const int end = std::min(first + pixels, plane_.cols);
            int at = 0;
            place(ratio, (first + end - 1) / 2.0, 1, &at, 1);
            mix_rows(rows_around(at >> 7).data(), table_ + (at & (phases - 1)) * taps, mixed_row(),
                     first * channels, end * channels);
        }
    }

    INLINE void mix_turned(const Ratio &ratio)
    {
        place(ratio, (shared_pixels - 1) / 2.0, shared_pixels, places_.data(), groups_);
        look_up<shared_pixels * channels>(places_.data(), groups_, table_, row_weights_.of_taps());
        for (int first = 0; first < groups_;) {
            int end = first + 1;
            const int whole = places_[static_cast<size_t>(first)] >> 7;
            while (end < groups_ && places_[static_cast<size_t>(end)] >> 7 == whole)
                end++;
            mix_turned_rows(rows_around(whole).data(), row_weights_.of_taps(), mixed_row(),
                            first * shared_pixels * channels,
                            std::min(end * shared_pixels, plane_.cols) * channels);
            first = end;
        }
    }

    float *mixed_row() { return mixed_.data() + beside_ * channels; }

    INLINE std::array<const float *, taps> rows_around(int whole)
    {
        static_assert(phases == 1 << 7);
        std::array<const float *, taps> rows;
        for (int k = 0; k < taps; k++)
            rows[static_cast<size_t>(k)] = rows_of_plane_.at(whole - before + k);
        return rows;
    }

    /* Mirrors the mixed row at its ends. */
    INLINE void extend()
    {
        float *row = mixed_row(), *last = row + (plane_.cols - 1) * channels;
        for (int i = 1; i <= beside_; i++)
            for (int j = 0; j < channels; j++) {
                row[j - i * channels] = row[j + i * channels];
                last[j + i * channels] = last[j - i * channels];
            }
    }

    INLINE bool is_stale(int y) const
    {
        const Ratio now = columns(y), then = columns(weighed_);
        const auto moved = [&](double u) { return std::abs(now.at(u) - then.at(u)); };
        return std::max({moved(0), moved(plane_.cols / 2.0), moved(plane_.cols - 1.0)}) > stale;
    }

    INLINE void weigh_columns(int y)
    {
        weighed_ = y;
        place(columns(y), 0.0, 1, places_.data(), plane_.cols);
        look_up<channels>(places_.data(), plane_.cols, table_, column_weights_.of_taps());
        runs_.clear();
        for (int u = 0; u < plane_.cols; u++) {
            const int shift = (places_[static_cast<size_t>(u)] >> 7) - before - u;
            if (runs_.empty() || runs_.back().shift != shift)
                runs_.push_back({u, u, shift});
            runs_.back().end = u + 1;
        }
    }

    const cv::Mat &plane_;
    cv::Matx33d m_;
    int groups_; /* of pixels that share a position along the column */
    int beside_; /* columns of room at both ends of the mixed row */
    std::vector<float> mixed_;
    FloatRows<Sample> rows_of_plane_;
    std::vector<int> places_;
    RowWeights column_weights_, row_weights_;
    const float *table_;
    std::vector<Run> runs_;
    int weighed_ = 0; /* the row that the weights along rows are for */
};

template <typename Sample, int channels>
INLINE void warp_range_here(const cv::Mat &plane, cv::Mat &warped, const cv::Matx33d &matrix,
                            const cv::Range &rows)
{
    RowWarper<Sample, channels> warper(plane, matrix);
    for (int y = rows.start; y < rows.end; y++)
        warper.warp(y, warped.ptr<Sample>(y));
}

#if WITH_WIDE_REGISTERS
template <typename Sample, int channels>
WIDE_REGISTERS void warp_range_wide(const cv::Mat &plane, cv::Mat &warped, const cv::Matx33d &matrix,
                                    const cv::Range &rows)
{
    warp_range_here<Sample, channels>(plane, warped, matrix, rows);
}

bool has_wide_registers()
{
    static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    return has;
}
#endif

template <typename Sample, int channels>
void warp_range(const cv::Mat &plane, cv::Mat &warped, const cv::Matx33d &matrix, const cv::Range &rows)
{
#if WITH_WIDE_REGISTERS
    if (has_wide_registers())
        return warp_range_wide<Sample, channels>(plane, warped, matrix, rows);
#endif
    warp_range_here<Sample, channels>(plane, warped, matrix, rows);
}

template <typename Sample> bool warp_rows(const cv::Mat &plane, cv::Mat &warped, const cv::Matx33d &matrix)
{
    constexpr std::array by_channels{warp_range<Sample, 1>, warp_range<Sample, 2>, warp_range<Sample, 3>,
                                     warp_range<Sample, 4>};
    const auto channels = static_cast<size_t>(plane.channels());
    if (channels > by_channels.size())
        return false;
    cv::parallel_for_(
        {0, plane.rows},
        [&](const cv::Range &rows) { by_channels[channels - 1](plane, warped, matrix, rows); },
        cv::getNumThreads());
    return true;
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
        return warp_rows<uchar>(plane, warped, matrix);
    case CV_16U:
        return warp_rows<ushort>(plane, warped, matrix);
    default:
        return false;
    }
}

} // namespace dff
