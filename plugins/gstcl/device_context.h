/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include "engine/opencl/device.h"

#include <gst/gst.h>
#include <memory>
#include <mutex>
#include <string>

namespace dff {

/* A context of the type GST_DFF_DEVICE_CONTEXT_TYPE with the open device and its name; not persistent, so
 * that pipelines forget it in NULL. */
GstContext *make_device_context(const std::shared_ptr<Device> &device);

/* The open device of such a context; nullptr if it only names one. */
std::shared_ptr<Device> device_in(const GstContext *context);

/* The device of an element that shares it by GstContext. */
class DeviceContext {
public:
    explicit DeviceContext(GstElement *element) : element_(element) {}
    ~DeviceContext() { close(); }

    DeviceContext(const DeviceContext &) = delete;
    DeviceContext &operator=(const DeviceContext &) = delete;

    /* The device of the context that the element was given, or else has from its neighbours downstream and
     * upstream, its bins or the application; or else one of its own, which the others are then told of. With
     * a `wish` only a device whose name contains it will do. To be called without any lock, since the
     * application's bus handler may run inside. Throws EngineError. */
    std::shared_ptr<Device> open(const std::string &wish);
    void close();

    /* Any thread. Answers a query for the context in use; false if this is another query, or there is none.
     */
    bool answer(GstQuery *query) const;

private:
    std::shared_ptr<Device> use(GstContext *context, const std::string &wish);
    std::shared_ptr<Device> use_own(const std::string &wish);
    std::shared_ptr<Device> use_set(const std::string &wish);
    std::shared_ptr<Device> ask_neighbours(GstPadDirection direction, const std::string &wish);

    GstElement *element_; /* which owns this */
    mutable std::mutex mutex_;
    GstContext *context_ = nullptr; /* in use; under the mutex, a leaf */
};

} // namespace dff
