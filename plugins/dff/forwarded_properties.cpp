/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "forwarded_properties.h"

namespace dff {

namespace {

/* A spec can belong to one class only. */
GParamSpec *copy_of(GParamSpec *spec)
{
    const gchar *name = g_param_spec_get_name(spec);
    const gchar *nick = g_param_spec_get_nick(spec);
    const gchar *blurb = g_param_spec_get_blurb(spec);
    const GParamFlags flags = spec->flags;
    if (G_IS_PARAM_SPEC_ENUM(spec))
        return g_param_spec_enum(name, nick, blurb, G_PARAM_SPEC_VALUE_TYPE(spec),
                                 G_PARAM_SPEC_ENUM(spec)->default_value, flags);
    if (G_IS_PARAM_SPEC_STRING(spec))
        return g_param_spec_string(name, nick, blurb, G_PARAM_SPEC_STRING(spec)->default_value, flags);
    if (G_IS_PARAM_SPEC_BOOLEAN(spec))
        return g_param_spec_boolean(name, nick, blurb, G_PARAM_SPEC_BOOLEAN(spec)->default_value, flags);
    if (G_IS_PARAM_SPEC_UINT(spec)) {
        const GParamSpecUInt *number = G_PARAM_SPEC_UINT(spec);
        return g_param_spec_uint(name, nick, blurb, number->minimum, number->maximum, number->default_value,
                                 flags);
    }
    if (G_IS_PARAM_SPEC_FLOAT(spec)) {
        const GParamSpecFloat *number = G_PARAM_SPEC_FLOAT(spec);
        return g_param_spec_float(name, nick, blurb, number->minimum, number->maximum, number->default_value,
                                  flags);
    }
    if (G_IS_PARAM_SPEC_DOUBLE(spec)) {
        const GParamSpecDouble *number = G_PARAM_SPEC_DOUBLE(spec);
        return g_param_spec_double(name, nick, blurb, number->minimum, number->maximum, number->default_value,
                                   flags);
    }
    g_warning("The property %s is not forwarded: its type is not known here", name);
    return nullptr;
}

bool has_property(GstElement *element, const GParamSpec *spec)
{
    return g_object_class_find_property(G_OBJECT_GET_CLASS(element), spec->name) != nullptr;
}

} // namespace

void install_forwarded_properties(GObjectClass *bin_class, guint first_id, const std::vector<GType> &types)
{
    for (const GType type : types) {
        auto *child_class = static_cast<GObjectClass *>(g_type_class_ref(type));
        guint count = 0;
        g_autofree GParamSpec **specs = g_object_class_list_properties(child_class, &count);
        for (guint k = 0; k < count; k++) {
            const bool own = specs[k]->owner_type == type && (specs[k]->flags & G_PARAM_WRITABLE);
            if (!own || g_object_class_find_property(bin_class, specs[k]->name))
                continue;
            if (GParamSpec *copy = copy_of(specs[k]))
                g_object_class_install_property(bin_class, first_id++, copy);
        }
        g_type_class_unref(child_class);
    }
}

void set_forwarded_property(const std::vector<GstElement *> &children, const GValue *value,
                            const GParamSpec *spec)
{
    for (GstElement *child : children)
        if (has_property(child, spec))
            g_object_set_property(G_OBJECT(child), spec->name, value);
}

void get_forwarded_property(const std::vector<GstElement *> &children, GValue *value, const GParamSpec *spec)
{
    for (GstElement *child : children)
        if (has_property(child, spec)) {
            g_object_get_property(G_OBJECT(child), spec->name, value);
            return;
        }
}

} // namespace dff
