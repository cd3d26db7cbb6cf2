/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "depthio/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <algorithm>
#include <limits>

namespace dff {

namespace {

class MemoryStream : public Imf::OStream {
public:
    MemoryStream() : Imf::OStream("memory") {}

    void write(const char bytes[], int count) override
    {
        const auto size = static_cast<size_t>(count);
        if (position_ + size > file_.size())
            file_.resize(position_ + size);
        std::copy_n(bytes, size, file_.begin() + static_cast<ptrdiff_t>(position_));
        position_ += size;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    std::vector<uint8_t> take() { return std::move(file_); }

private:
    std::vector<uint8_t> file_;
    size_t position_ = 0;
};

Imf::Compression compression_of(ExrCompression compression)
{
    switch (compression) {
    case ExrCompression::None:
        return Imf::NO_COMPRESSION;
    case ExrCompression::Rle:
        return Imf::RLE_COMPRESSION;
    case ExrCompression::Zips:
        return Imf::ZIPS_COMPRESSION;
    case ExrCompression::Piz:
        return Imf::PIZ_COMPRESSION;
    case ExrCompression::Dwaa:
        return Imf::DWAA_COMPRESSION;
    case ExrCompression::Dwab:
        return Imf::DWAB_COMPRESSION;
    case ExrCompression::Zip:
        break;
    }
    return Imf::ZIP_COMPRESSION;
}

Imf::Header header_of(const ExrPart &part, ExrCompression compression)
{
    Imf::Header header(static_cast<int>(part.colour.width), static_cast<int>(part.colour.height));
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    header.compression() = compression_of(compression);
    for (const char *channel : {"R", "G", "B"})
        header.channels().insert(channel, Imf::Channel(Imf::HALF));
    if (part.depth)
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    if (part.depth && part.uncertainty)
        header.channels().insert("uncertainty.Z", Imf::Channel(Imf::FLOAT));
    for (const auto &[name, value] : part.attributes) {
        if (const auto *number = std::get_if<float>(&value))
            header.insert(name, Imf::FloatAttribute(*number));
        else if (const auto *text = std::get_if<std::string>(&value))
            header.insert(name, Imf::StringAttribute(*text));
        else
            header.insert(name, Imf::FloatVectorAttribute(std::get<std::vector<float>>(value)));
    }
    return header;
}

std::vector<half> linear_colours(const PictureView &colour, const std::array<float, 256> &linear)
{
    std::array<half, 256> halves{};
    std::copy(linear.begin(), linear.end(), halves.begin());
    const size_t row_size = size_t{3} * colour.width;
    std::vector<half> pixels(row_size * colour.height);
    for (unsigned y = 0; y < colour.height; y++)
        std::transform(colour.row(y), colour.row(y) + row_size,
                       pixels.begin() + static_cast<ptrdiff_t>(row_size * y),
                       [&](uint8_t value) { return halves[value]; });
    return pixels;
}

std::vector<float> distances_of(const PictureView &depth, std::span<const float> distances)
{
    std::vector<float> pixels(size_t{depth.width} * depth.height);
    for (unsigned y = 0; y < depth.height; y++)
        for (unsigned x = 0; x < depth.width; x++)
            pixels[size_t{y} * depth.width + x] = distances[depth.depth(x, y)];
    return pixels;
}

std::vector<float> deviations_of(const PictureView &depth, const PictureView &uncertainty,
                                 std::span<const float> slopes)
{
    std::vector<float> pixels(size_t{depth.width} * depth.height, std::numeric_limits<float>::quiet_NaN());
    for (unsigned y = 0; y < depth.height; y++)
        for (unsigned x = 0; x < depth.width; x++)
            if (const uint16_t deviation = uncertainty.depth(x, y))
                pixels[size_t{y} * depth.width + x] = slopes[depth.depth(x, y)] * deviation;
    return pixels;
}

/* A channel in single precision. */
Imf::Slice slice_of(std::vector<float> &pixels, unsigned width)
{
    return {Imf::FLOAT, reinterpret_cast<char *>(pixels.data()), sizeof(float), sizeof(float) * width};
}

void write_part(Imf::OutputPart file, const ExrPart &part, const ExrFormat &format)
{
    constexpr size_t colour_bytes = 3 * sizeof(half);
    const unsigned width = part.colour.width;
    std::vector<half> colours = linear_colours(part.colour, format.linear);
    std::vector<float> distances, deviations;

    Imf::FrameBuffer frame;
    size_t channel = 0;
    for (const char *name : {"R", "G", "B"})
        frame.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char *>(&colours[channel++]), colour_bytes,
                                      colour_bytes * width));
    if (part.depth) {
        distances = distances_of(*part.depth, format.distances);
        frame.insert("Z", slice_of(distances, width));
    }
    if (part.depth && part.uncertainty) {
        deviations = deviations_of(*part.depth, *part.uncertainty, format.slopes);
        frame.insert("uncertainty.Z", slice_of(deviations, width));
    }
    file.setFrameBuffer(frame);
    file.writePixels(static_cast<int>(part.colour.height));
}

} // namespace

std::vector<uint8_t> write_exr(std::span<const ExrPart> parts, const ExrFormat &format)
{
    std::vector<Imf::Header> headers;
    for (const ExrPart &part : parts)
        headers.push_back(header_of(part, format.compression));

    MemoryStream stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()));
        for (size_t k = 0; k < parts.size(); k++)
            write_part(Imf::OutputPart(file, static_cast<int>(k)), parts[k], format);
    } /* which writes the table of lines */
    return stream.take();
}

} // namespace dff
