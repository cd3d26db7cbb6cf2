/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/small_stack.h"

#include "engine/cell_sums.h"
#include "focalstack/in_parallel.h"

#include <algorithm>

namespace dff {

namespace {

int factor_of(const StackShape &shape)
{
    int factor = 2;
    while (shape.width / static_cast<uint32_t>(factor) > SmallStack::most_width)
        factor *= 2;
    return factor;
}

/* Means over cells of side x side samples of 8 bits of a picture of one channel. */
template <unsigned side> void take_plain_means(const cv::Mat &picture, float scale, cv::Mat1f &means)
{
    CellSums<side> cells(static_cast<size_t>(means.cols));
    for (int y = 0; y < means.rows; y++) {
        const auto sums =
            cells.of(picture.ptr<std::byte>(y * static_cast<int>(side)), static_cast<size_t>(picture.step));
        std::transform(sums.begin(), sums.end(), means[y],
                       [scale](int32_t sum) { return static_cast<float>(sum) * scale; });
    }
}

/* Of a column of a cell: 32 samples of 8 bits fit into 16. */
template <typename Sample> struct SumOf;
template <> struct SumOf<uint8_t> {
    using Type = uint16_t;
};
template <> struct SumOf<uint16_t> {
    using Type = uint32_t;
};

/* Means over cells of side x side pixels of every `stride`-th sample of a row, from `channel` on. */
template <typename Sample, int stride, int side>
void take_means(const cv::Mat &picture, int channel, float scale, cv::Mat1f &means)
{
    std::vector<typename SumOf<Sample>::Type> columns(static_cast<size_t>(means.cols) *
                                                      static_cast<size_t>(side));
    for (int y = 0; y < means.rows; y++) {
        std::fill(columns.begin(), columns.end(), typename SumOf<Sample>::Type{0});
        for (int i = 0; i < side; i++) {
            const Sample *row = picture.ptr<Sample>(y * side + i) + channel;
            for (size_t x = 0; x < columns.size(); x++)
                columns[x] = static_cast<typename SumOf<Sample>::Type>(columns[x] + row[x * stride]);
        }
        float *out = means[y];
        for (size_t x = 0; x * side < columns.size(); x++) {
            uint32_t sum = 0;
            for (size_t i = 0; i < side; i++)
                sum += columns[x * side + i];
            out[x] = static_cast<float>(sum) * scale;
        }
    }
}

template <typename Sample, int stride>
void take_means(const cv::Mat &picture, int channel, int side, float scale, cv::Mat1f &means)
{
    switch (side) {
    case 1:
        return take_means<Sample, stride, 1>(picture, channel, scale, means);
    case 2:
        return take_means<Sample, stride, 2>(picture, channel, scale, means);
    case 4:
        return take_means<Sample, stride, 4>(picture, channel, scale, means);
    case 8:
        return take_means<Sample, stride, 8>(picture, channel, scale, means);
    case 16:
        return take_means<Sample, stride, 16>(picture, channel, scale, means);
    default:
        return take_means<Sample, stride, 32>(picture, channel, scale, means);
    }
}

template <typename Sample>
void take_means(const cv::Mat &picture, int channel, int side, float scale, cv::Mat1f &means)
{
    switch (picture.channels()) {
    case 1:
        return take_means<Sample, 1>(picture, channel, side, scale, means);
    case 2:
        return take_means<Sample, 2>(picture, channel, side, scale, means);
    case 3:
        return take_means<Sample, 3>(picture, channel, side, scale, means);
    default:
        return take_means<Sample, 4>(picture, channel, side, scale, means);
    }
}

} // namespace

StackPictureViews pictures_of(const StackView &view, std::span<std::byte> memory)
{
    const auto components = view.shape.components();
    StackPictureViews pictures(view.shape.planes);
    for (uint32_t z = 0; z < view.shape.planes; z++)
        for (size_t c = 0; c < components.size(); c++) {
            const RowLayout &rows = view.layout[c * view.shape.planes + z];
            const int channels = static_cast<int>(components[c].channels);
            pictures[z].emplace_back(static_cast<int>(components[c].height),
                                     static_cast<int>(components[c].width) / channels,
                                     CV_MAKETYPE(components[c].sample_bytes == 2 ? CV_16U : CV_8U, channels),
                                     memory.data() + rows.offset, rows.stride);
        }
    return pictures;
}

int shown_channels(const Component &component)
{
    return static_cast<int>(std::min(component.channels, 3U));
}

SmallStack::SmallStack(const StackShape &shape)
    : shape_(shape), components_(shape.components()), factor_(factor_of(shape)),
      size_(static_cast<int>(shape.width) / factor_, static_cast<int>(shape.height) / factor_)
{
    for (size_t c = 0; c < components_.size(); c++)
        component_of_.insert(component_of_.end(), static_cast<size_t>(shown_channels(components_[c])), c);
    pictures_.resize(shape.planes);
    for (auto &plane : pictures_)
        for (size_t i = 0; i < component_of_.size(); i++)
            plane.emplace_back(size_);
}

double SmallStack::samples(unsigned channel) const
{
    const double side = factor_ / static_cast<double>(components_[component_of_[channel]].subsampling);
    return side * side;
}

void SmallStack::take(const StackPictureViews &pictures)
{
    in_parallel(planes(), [&](unsigned z) {
        for (unsigned channel = 0; channel < channels(); channel++)
            take(pictures, z, channel, {0, size_.height});
    });
}

void SmallStack::take(const StackPictureViews &pictures, unsigned z, unsigned channel, const cv::Range &rows)
{
    const size_t c = component_of_[channel];
    const auto first = std::find(component_of_.begin(), component_of_.end(), c) - component_of_.begin();
    const int of_component = static_cast<int>(channel) - static_cast<int>(first);
    const int side = factor_ / static_cast<int>(components_[c].subsampling);
    const cv::Mat picture = pictures[z][c].rowRange(rows.start * side, rows.end * side);
    const auto scale = static_cast<float>(1.0 / samples(channel));
    cv::Mat1f means = pictures_[z][channel].rowRange(rows);
    if (components_[c].sample_bytes == 1 && picture.channels() == 1 && side == 4)
        take_plain_means<4>(picture, scale, means);
    else if (components_[c].sample_bytes == 1 && picture.channels() == 1 && side == 2)
        take_plain_means<2>(picture, scale, means);
    else if (components_[c].sample_bytes == 2)
        take_means<uint16_t>(picture, of_component, side, scale / 256.0F, means);
    else
        take_means<uint8_t>(picture, of_component, side, scale, means);
}

void SmallStack::take(const SmallStack &other, unsigned z)
{
    for (unsigned channel = 0; channel < channels(); channel++)
        other.pictures_[z][channel].copyTo(pictures_[z][channel]);
}

cv::Mat1f SmallStack::luma(unsigned z) const
{
    const auto &plane = pictures_[z];
    switch (shape_.format) {
    case PixelFormat::Rgb:
    case PixelFormat::Rgbx:
    case PixelFormat::Rgba64:
        return cv::Mat1f(0.299F * plane[0] + 0.587F * plane[1] + 0.114F * plane[2]);
    case PixelFormat::Bgr:
    case PixelFormat::Bgrx:
        return cv::Mat1f(0.114F * plane[0] + 0.587F * plane[1] + 0.299F * plane[2]);
    default:
        return plane[0];
    }
}

} // namespace dff
