/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "common/checked_properties.h"

namespace dff {

namespace {

/* A spec of the same type to who inspects it, whose range GLib does not enforce. */
GType checked_type(GType parent)
{
    const std::string name = std::string("DffChecked") + g_type_name(parent);
    const GType known = g_type_from_name(name.c_str()); /* another plug-in may have been first */
    if (known != G_TYPE_INVALID)
        return known;
    GTypeQuery size;
    g_type_query(parent, &size);
    const GClassInitFunc enforce_nothing = [](gpointer klass, gpointer) {
        auto *spec_class = G_PARAM_SPEC_CLASS(klass);
        spec_class->value_validate = [](GParamSpec *, GValue *) -> gboolean { return FALSE; };
#if GLIB_CHECK_VERSION(2, 74, 0)
        spec_class->value_is_valid = [](GParamSpec *, const GValue *) -> gboolean { return TRUE; };
#endif
    };
    const GTypeInfo info{
        static_cast<guint16>(size.class_size),    nullptr, nullptr, enforce_nothing, nullptr, nullptr,
        static_cast<guint16>(size.instance_size), 0,       nullptr, nullptr};
    return g_type_register_static(parent, name.c_str(), &info, static_cast<GTypeFlags>(0));
}

template <typename Spec> GParamSpec *copy_as_checked(GParamSpec *spec)
{
    auto *copy = static_cast<GParamSpec *>(
        g_param_spec_internal(checked_type(G_PARAM_SPEC_TYPE(spec)), g_param_spec_get_name(spec),
                              g_param_spec_get_nick(spec), g_param_spec_get_blurb(spec), spec->flags));
    copy->value_type = spec->value_type;
    const auto *from = reinterpret_cast<Spec *>(spec);
    auto *to = reinterpret_cast<Spec *>(copy);
    to->minimum = from->minimum;
    to->maximum = from->maximum;
    to->default_value = from->default_value;
    return copy;
}

bool is_checked(const GParamSpec *spec)
{
    return g_str_has_prefix(G_PARAM_SPEC_TYPE_NAME(spec), "DffChecked");
}

std::string text_of(double number)
{
    gchar text[G_ASCII_DTOSTR_BUF_SIZE];
    return g_ascii_formatd(text, sizeof text, "%g", number);
}

struct Range {
    double minimum;
    double maximum;
    double value;
};

Range range_of(GParamSpec *spec, const GValue *value)
{
    if (G_VALUE_HOLDS_UINT(value)) {
        const auto *range = reinterpret_cast<GParamSpecUInt *>(spec);
        return {static_cast<double>(range->minimum), static_cast<double>(range->maximum),
                static_cast<double>(g_value_get_uint(value))};
    }
    if (G_VALUE_HOLDS_INT(value)) {
        const auto *range = reinterpret_cast<GParamSpecInt *>(spec);
        return {static_cast<double>(range->minimum), static_cast<double>(range->maximum),
                static_cast<double>(g_value_get_int(value))};
    }
    const auto *range = reinterpret_cast<GParamSpecDouble *>(spec);
    return {range->minimum, range->maximum, g_value_get_double(value)};
}

} // namespace

GParamSpec *checked_at_start(GParamSpec *spec)
{
    GParamSpec *checked = nullptr;
    if (spec->value_type == G_TYPE_UINT)
        checked = copy_as_checked<GParamSpecUInt>(spec);
    else if (spec->value_type == G_TYPE_INT)
        checked = copy_as_checked<GParamSpecInt>(spec);
    else if (spec->value_type == G_TYPE_DOUBLE)
        checked = copy_as_checked<GParamSpecDouble>(spec);
    g_return_val_if_fail(checked != nullptr, spec);
    g_param_spec_sink(spec);
    return checked;
}

std::optional<std::string> value_out_of_range(GObject *object)
{
    guint count = 0;
    g_autofree GParamSpec **specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(object), &count);
    for (guint i = 0; i < count; i++) {
        if (!is_checked(specs[i]))
            continue;
        g_auto(GValue) value = G_VALUE_INIT;
        g_value_init(&value, specs[i]->value_type);
        g_object_get_property(object, specs[i]->name, &value);
        const Range range = range_of(specs[i], &value);
        if (!(range.value >= range.minimum && range.value <= range.maximum))
            return std::string(specs[i]->name) + "=" + text_of(range.value) +
                   " is out of range: " + text_of(range.minimum) + " to " + text_of(range.maximum);
    }
    return std::nullopt;
}

} // namespace dff
