/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/video/video.h>
#include <memory>

namespace dff {

/* Pictures in another format, by GStreamer's converter. */
class ColorConverter {
public:
    /* From here on pictures of `from` become such of `format`; those that have it already are left alone. */
    void start(const GstVideoInfo &from, GstVideoFormat format);
    void stop();

    /* Of what convert() returns. */
    const GstVideoInfo &info() const { return to_; }

    /* The picture, or a copy in the other format that is valid until the next one. Throws std::runtime_error
     * with a user's text if the buffer does not hold what its caps say. */
    GstBuffer *convert(GstBuffer *picture);

private:
    struct ConverterFree {
        void operator()(GstVideoConverter *converter) const { gst_video_converter_free(converter); }
    };
    struct BufferUnref {
        void operator()(GstBuffer *buffer) const { gst_buffer_unref(buffer); }
    };

    GstVideoInfo from_{}, to_{};
    std::unique_ptr<GstVideoConverter, ConverterFree> converter_; /* null: the format is the wanted one */
    std::unique_ptr<GstBuffer, BufferUnref> converted_;
};

} // namespace dff
