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

/* Points at a GObject while it lives. */
template <typename T> class WeakPointer {
public:
    WeakPointer() { g_weak_ref_init(&reference_, nullptr); }
    ~WeakPointer() { g_weak_ref_clear(&reference_); }
    WeakPointer(const WeakPointer &) = delete;
    WeakPointer &operator=(const WeakPointer &) = delete;

    void set(T *object) { g_weak_ref_set(&reference_, object); }
    ObjectPointer<T> get() { return ObjectPointer<T>(static_cast<T *>(g_weak_ref_get(&reference_))); }

private:
    GWeakRef reference_;
};

struct SampleUnref {
    void operator()(GstSample *sample) const { gst_sample_unref(sample); }
};
using SamplePointer = std::unique_ptr<GstSample, SampleUnref>;

} // namespace dff
