/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <gst/gst.h>
#include <memory>

namespace dff {

/* Owns one reference to a GObject of type T. */
template <typename T> struct ObjectUnref {
    void operator()(T *object) const { g_object_unref(object); }
};
template <typename T> using ObjectPointer = std::unique_ptr<T, ObjectUnref<T>>;

/* A further reference to an object that someone else owns too. */
template <typename T> ObjectPointer<T> share(T *object)
{
    return ObjectPointer<T>(static_cast<T *>(g_object_ref(object)));
}

struct SampleUnref {
    void operator()(GstSample *sample) const { gst_sample_unref(sample); }
};
using SamplePointer = std::unique_ptr<GstSample, SampleUnref>;

} // namespace dff
