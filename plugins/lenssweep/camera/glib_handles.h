/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#pragma once

#include <glib-object.h>
#include <memory>
#include <stdexcept>
#include <string>

namespace dff {

struct ObjectUnref {
    void operator()(gpointer object) const { g_object_unref(object); }
};

template <typename Object> using ObjectRef = std::unique_ptr<Object, ObjectUnref>;

/* Takes the GError of a call: some_call(..., error.out()); error.check("what failed"). */
class CallError {
public:
    CallError() = default;
    CallError(const CallError &) = delete;
    CallError &operator=(const CallError &) = delete;
    ~CallError() { g_clear_error(&error_); }

    GError **out() { return &error_; }
    bool failed() const { return error_ != nullptr; }
    bool is(GQuark domain, int code) const { return g_error_matches(error_, domain, code) != FALSE; }

    /* Throws an Error that begins with `what`. */
    template <typename Error = std::runtime_error> void check(const std::string &what) const
    {
        if (error_)
            throw Error(what + ": " + error_->message);
    }

private:
    GError *error_ = nullptr;
};

} // namespace dff
