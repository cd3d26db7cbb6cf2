/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "focalstack/bad_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace dff {

namespace {

constexpr int stands_out = 12;  /* of 255: what is less does little harm */
constexpr int another_part = 8; /* of 255: by so much its neighbours' mean differs before it */
constexpr int enough_parts = 3; /* of the scene, before which a bad pixel stood out */
constexpr int most_parts = 8;   /* that count, so that it is forgotten after as many sweeps */
constexpr int slices = 32;      /* of the rows, one of which is searched in each sweep */
constexpr int most_are = 400;   /* one of so many pixels is bad at most: more are what all planes show */

bool is_before(const cv::Point &a, const cv::Point &b)
{
    return a.y != b.y ? a.y < b.y : a.x < b.x;
}

template <typename Sample> constexpr int margin = stands_out << (8 * (sizeof(Sample) - 1));

/* Whether a sample that is not at the border is more than `margin` above, or below, all of its neighbours. */
template <typename Sample> bool stands(const cv::Mat &picture, const cv::Point &sample, bool is_bright)
{
    const int channels = picture.channels(), sign = is_bright ? 1 : -1;
    const int own = sign * picture.ptr<Sample>(sample.y)[sample.x] - margin<Sample>;
    for (int y = sample.y - 1; y <= sample.y + 1; y++)
        for (int x = sample.x - channels; x <= sample.x + channels; x += channels)
            if ((y != sample.y || x != sample.x) && sign * picture.ptr<Sample>(y)[x] >= own)
                return false;
    return true;
}

bool stands(const cv::Mat &picture, const cv::Point &sample, bool is_bright)
{
    return picture.depth() == CV_16U ? stands<uint16_t>(picture, sample, is_bright)
                                     : stands<uint8_t>(picture, sample, is_bright);
}

/* In nine tenths of the planes: noise, or something as bright as the pixel, hides it in a few. */
bool stands_in_most(std::span<const cv::Mat> planes, const cv::Point &sample, bool is_bright)
{
    std::size_t left = planes.size() / 10;
    for (const cv::Mat &plane : planes)
        if (!stands(plane, sample, is_bright) && left-- == 0)
            return false;
    return true;
}

/* Mean of a sample's neighbours in all planes. */
template <typename Sample> double mean_around(std::span<const cv::Mat> planes, const cv::Point &sample)
{
    double sum = 0.0;
    for (const cv::Mat &plane : planes) {
        const int channels = plane.channels();
        for (int y = sample.y - 1; y <= sample.y + 1; y++)
            for (int x = sample.x - channels; x <= sample.x + channels; x += channels)
                sum += y != sample.y || x != sample.x ? plane.ptr<Sample>(y)[x] : 0;
    }
    return sum / (8.0 * static_cast<double>(planes.size()));
}

double mean_around(std::span<const cv::Mat> planes, const cv::Point &sample)
{
    return planes.front().depth() == CV_16U ? mean_around<uint16_t>(planes, sample)
                                            : mean_around<uint8_t>(planes, sample);
}

double mean_of(const cv::Mat &picture)
{
    const cv::Scalar means = cv::mean(picture);
    double sum = 0.0;
    for (int i = 0; i < picture.channels(); i++)
        sum += means[i];
    return sum / picture.channels();
}

/* Gives each sample of one row that stands out from the four nearest to `found`, in steps that the compiler
 * makes vectors of. */
template <typename Sample, typename Found>
void search_row(const cv::Mat &picture, int y, std::vector<Sample> &high, std::vector<Sample> &low,
                const Found &found)
{
    const Sample *above = picture.ptr<Sample>(y - 1), *row = picture.ptr<Sample>(y),
                 *below = picture.ptr<Sample>(y + 1);
    const int channels = picture.channels(), count = picture.cols * channels;
    for (int x = channels; x < count - channels; x++) {
        const auto at = static_cast<std::size_t>(x);
        high[at] = std::max(std::max(above[x], below[x]), std::max(row[x - channels], row[x + channels]));
        low[at] = std::min(std::min(above[x], below[x]), std::min(row[x - channels], row[x + channels]));
    }
    constexpr int run = 64;
    for (int first = channels; first < count - channels; first += run) {
        const int end = std::min(first + run, count - channels);
        int is_any = 0;
        for (int x = first; x < end; x++) {
            const auto at = static_cast<std::size_t>(x);
            is_any |= row[x] > high[at] + margin<Sample> || row[x] < low[at] - margin<Sample>;
        }
        for (int x = first; is_any && x < end; x++) {
            const auto at = static_cast<std::size_t>(x);
            if (row[x] > high[at] + margin<Sample>)
                found(cv::Point(x, y), true);
            else if (row[x] < low[at] - margin<Sample>)
                found(cv::Point(x, y), false);
        }
    }
}

template <typename Sample, typename Found>
void search_rows(const cv::Mat &picture, int first, int end, const Found &found)
{
    const std::size_t samples =
        static_cast<std::size_t>(picture.cols) * static_cast<std::size_t>(picture.channels());
    std::vector<Sample> high(samples), low(samples);
    for (int y = std::max(first, 1); y < std::min(end, picture.rows - 1); y++)
        search_row<Sample>(picture, y, high, low, found);
}

template <typename Sample> void repair(cv::Mat &picture, const cv::Point &place)
{
    const int channels = picture.channels();
    for (int i = 0; i < channels; i++) {
        std::array<Sample, 8> around;
        std::size_t count = 0;
        for (int y = std::max(place.y - 1, 0); y <= std::min(place.y + 1, picture.rows - 1); y++)
            for (int x = std::max(place.x - 1, 0); x <= std::min(place.x + 1, picture.cols - 1); x++)
                if (y != place.y || x != place.x)
                    around[count++] = picture.ptr<Sample>(y)[x * channels + i];
        const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
        std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
        if (count > 0)
            picture.ptr<Sample>(place.y)[place.x * channels + i] = *middle;
    }
}

} // namespace

/* All rows of the first plane, later a slice of one plane's: what stands out in it and in the others. */
void BadPixels::add_suspects(std::span<const cv::Mat> planes)
{
    const cv::Mat &picture = planes[searched_ % planes.size()];
    const int first = slice_ < 0 ? 0 : picture.rows * slice_ / slices;
    const int end = slice_ < 0 ? picture.rows : picture.rows * (slice_ + 1) / slices;
    slice_ = (slice_ + 1) % slices;
    searched_++;
    std::vector<Suspect> found;
    const auto add = [&](const cv::Point &sample, bool is_bright) {
        if (stands_in_most(planes, sample, is_bright))
            found.push_back({sample, is_bright, 0, false, 0.0, 0.0});
    };
    if (picture.depth() == CV_16U)
        search_rows<uint16_t>(picture, first, end, add);
    else
        search_rows<uint8_t>(picture, first, end, add);
    std::vector<Suspect> all;
    std::ranges::set_union(suspects_, found, std::back_inserter(all), is_before, &Suspect::sample,
                           &Suspect::sample);
    suspects_ = std::move(all);
}

void BadPixels::tell_places(const cv::Mat &picture)
{
    places_.clear();
    for (const Suspect &suspect : suspects_) {
        const cv::Point place(suspect.sample.x / picture.channels(), suspect.sample.y);
        if (suspect.is_bad && (places_.empty() || places_.back() != place))
            places_.push_back(place);
    }
}

/* Another part of the scene is before a suspect where its neighbours have changed, and not by the light on
 * all of the picture. */
void BadPixels::judge(Suspect &suspect, std::span<const cv::Mat> planes, double brightness)
{
    if (!stands_in_most(planes, suspect.sample, suspect.is_bright)) {
        suspect.parts--;
        return;
    }
    const double around = mean_around(planes, suspect.sample);
    const double same = suspect.around * brightness / std::max(suspect.brightness, 1.0);
    const double unit = planes.front().depth() == CV_16U ? 256.0 : 1.0;
    if (suspect.parts > 0 && std::abs(around - same) <= another_part * unit)
        return;
    suspect.parts = std::min(suspect.parts + 1, most_parts);
    suspect.is_bad = suspect.is_bad || suspect.parts >= enough_parts;
    suspect.around = around;
    suspect.brightness = brightness;
}

void BadPixels::look(std::span<const cv::Mat> planes)
{
    if (planes.size() < fewest_planes)
        return;
    add_suspects(planes);
    if (suspects_.empty())
        return;
    const double brightness = mean_of(planes.front());
    for (Suspect &suspect : suspects_)
        judge(suspect, planes, brightness);
    std::erase_if(suspects_, [](const Suspect &suspect) { return suspect.parts <= 0; });
    const cv::Mat &picture = planes.front();
    if (suspects_.size() * most_are > picture.total() * static_cast<std::size_t>(picture.channels())) {
        suspects_.clear();
        slice_ = -1;
    }
    tell_places(picture);
}

void repair_pixels(cv::Mat picture, std::span<const cv::Point> places, int step)
{
    for (const cv::Point &place : places) {
        const cv::Point sample(std::min(place.x / step, picture.cols - 1),
                               std::min(place.y / step, picture.rows - 1));
        if (picture.depth() == CV_16U)
            repair<uint16_t>(picture, sample);
        else
            repair<uint8_t>(picture, sample);
    }
}

} // namespace dff
