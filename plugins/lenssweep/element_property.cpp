/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "element_property.h"

#include <optional>

namespace {

constexpr const char *autofocus = "af-mode"; /* of libcamerasrc */
constexpr const char *manual = "manual";

/* A number of any type becomes one of another. */
double double_of(const GValue *value)
{
    g_auto(GValue) number = G_VALUE_INIT;
    g_value_init(&number, G_TYPE_DOUBLE);
    g_value_transform(value, &number);
    return g_value_get_double(&number);
}

bool is_number(const GParamSpec *spec)
{
    const GType type = spec->value_type;
    return g_type_is_a(type, G_TYPE_INT) || g_type_is_a(type, G_TYPE_UINT) ||
           g_type_is_a(type, G_TYPE_LONG) || g_type_is_a(type, G_TYPE_ULONG) ||
           g_type_is_a(type, G_TYPE_INT64) || g_type_is_a(type, G_TYPE_UINT64) ||
           g_type_is_a(type, G_TYPE_FLOAT) || g_type_is_a(type, G_TYPE_DOUBLE);
}

template <typename Spec> std::pair<double, double> range_of(const Spec *spec)
{
    return {static_cast<double>(spec->minimum), static_cast<double>(spec->maximum)};
}

std::pair<double, double> range_of_number(GParamSpec *spec)
{
    if (G_IS_PARAM_SPEC_INT(spec))
        return range_of(G_PARAM_SPEC_INT(spec));
    if (G_IS_PARAM_SPEC_UINT(spec))
        return range_of(G_PARAM_SPEC_UINT(spec));
    if (G_IS_PARAM_SPEC_INT64(spec))
        return range_of(G_PARAM_SPEC_INT64(spec));
    if (G_IS_PARAM_SPEC_UINT64(spec))
        return range_of(G_PARAM_SPEC_UINT64(spec));
    if (G_IS_PARAM_SPEC_FLOAT(spec))
        return range_of(G_PARAM_SPEC_FLOAT(spec));
    if (G_IS_PARAM_SPEC_DOUBLE(spec))
        return range_of(G_PARAM_SPEC_DOUBLE(spec));
    if (G_IS_PARAM_SPEC_LONG(spec))
        return range_of(G_PARAM_SPEC_LONG(spec));
    return range_of(G_PARAM_SPEC_ULONG(spec));
}

class ElementProperty : public dff::LensProperty {
public:
    ElementProperty(GstElement *element, GParamSpec *spec) : spec_(spec), name_(text_of(element, spec))
    {
        g_weak_ref_init(&element_, element);
    }
    ~ElementProperty() override { g_weak_ref_clear(&element_); }
    ElementProperty(const ElementProperty &) = delete;
    ElementProperty &operator=(const ElementProperty &) = delete;

    std::string name() const override { return name_; }
    bool is_integer() const override
    {
        return spec_->value_type != G_TYPE_DOUBLE && spec_->value_type != G_TYPE_FLOAT;
    }
    std::pair<double, double> range() override { return range_of_number(spec_); }
    double get() override;
    void set(double value) override;
    void take_over() override;
    void give_back() override;

private:
    static std::string text_of(GstElement *element, GParamSpec *spec)
    {
        g_autofree gchar *name = gst_object_get_name(GST_OBJECT(element));
        return std::string(name) + "." + g_param_spec_get_name(spec);
    }
    GObject *owned();

    GWeakRef element_;
    GParamSpec *spec_; /* lives as long as the element's class */
    std::string name_;
    std::optional<gint> mode_before_; /* of the autofocus */
};

/* A reference for the caller. */
GObject *ElementProperty::owned()
{
    auto *element = static_cast<GObject *>(g_weak_ref_get(&element_));
    g_autoptr(GstObject) parent = element ? gst_object_get_parent(GST_OBJECT(element)) : nullptr;
    if (parent)
        return element;
    g_clear_object(&element);
    throw dff::LensError("the element of " + name_ + " is in the pipeline no more");
}

double ElementProperty::get()
{
    g_autoptr(GObject) element = owned();
    g_auto(GValue) value = G_VALUE_INIT;
    g_value_init(&value, spec_->value_type);
    g_object_get_property(element, spec_->name, &value);
    return double_of(&value);
}

void ElementProperty::set(double number)
{
    g_autoptr(GObject) element = owned();
    g_auto(GValue) value = G_VALUE_INIT;
    g_value_init(&value, G_TYPE_DOUBLE);
    g_value_set_double(&value, number);
    g_object_set_property(element, spec_->name, &value); /* which turns the number into its own type */
}

void ElementProperty::take_over()
{
    g_autoptr(GObject) element = owned();
    GParamSpec *spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), autofocus);
    if (!spec || !G_IS_PARAM_SPEC_ENUM(spec))
        return;
    const GEnumValue *value = g_enum_get_value_by_nick(G_PARAM_SPEC_ENUM(spec)->enum_class, manual);
    if (!value)
        return;
    gint now = 0;
    g_object_get(element, autofocus, &now, nullptr);
    mode_before_ = now;
    g_object_set(element, autofocus, value->value, nullptr);
}

void ElementProperty::give_back()
{
    if (!mode_before_)
        return;
    g_autoptr(GObject) element = owned();
    g_object_set(element, autofocus, *mode_before_, nullptr);
    mode_before_.reset();
}

GstElement *find_element(GstElement *self, const std::string &name)
{
    g_autoptr(GstObject) parent = gst_object_get_parent(GST_OBJECT(self));
    if (!parent || !GST_IS_BIN(parent))
        return nullptr;
    return gst_bin_get_by_name_recurse_up(GST_BIN(parent), name.c_str());
}

} // namespace

std::unique_ptr<dff::LensProperty> find_element_property(GstElement *self, const std::string &name,
                                                         const std::string &property)
{
    g_autoptr(GstElement) element = find_element(self, name);
    if (!element)
        throw dff::LensError("no element of the pipeline is called " + name + ": write name=" + name +
                             " at the camera that has the lens, as in libcamerasrc name=" + name);
    GParamSpec *spec = g_object_class_find_property(G_OBJECT_GET_CLASS(element), property.c_str());
    const std::string type = G_OBJECT_TYPE_NAME(element);
    if (!spec)
        throw dff::LensError(
            "the element " + name + ", a " + type + ", has no property " + property +
            ": gst-inspect-1.0 lists those it has. libcamerasrc has lens-position from libcamera "
            "0.4 on");
    constexpr auto both = static_cast<GParamFlags>(G_PARAM_READABLE | G_PARAM_WRITABLE);
    if (!is_number(spec) || (spec->flags & both) != both)
        throw dff::LensError("the property " + property + " of the element " + name + ", a " + type +
                             ", is no number that can be set and read, so it moves no lens");
    return std::make_unique<ElementProperty>(element, spec);
}
