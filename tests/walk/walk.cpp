/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "walk.h"

#include "property_values.h"

#include <algorithm>

namespace dff::walk {

namespace {

Shape some_shape(Chance &chance)
{
    const auto width = chance.of({64, 80});
    return {width, width == 64 ? 64 : 70, chance.of({2, 3})};
}

} // namespace

Walk::Walk(const std::string &factory, std::uint64_t seed, Story &story)
    : story_(story), chance_(seed), shape_(some_shape(chance_)), pipeline_(gst_pipeline_new("walk")),
      element_(gst_element_factory_make(factory.c_str(), "element"))
{
    gst_bin_add(GST_BIN(pipeline_), element_);
    const bool own_pad_each = chance_.percent(40);
    g_autoptr(GList) pads = g_list_copy(element_->pads);
    for (GList *item = pads; item; item = item->next) {
        auto *pad = GST_PAD(item->data);
        if (GST_PAD_IS_SRC(pad))
            add_sink(pad);
        else if (chance_.percent(90) && !(own_pad_each && factory == "focalstackmux"))
            add_feed(pad);
    }
    for (unsigned i = chance_.below(3); i > 0; i--)
        request_pad();
}

Walk::~Walk()
{
    leaves();
}

void Walk::add_feed(GstPad *pad)
{
    feeds_.push_back(std::make_unique<Feed>(pad, chance_, shape_));
    if (state_ >= GST_STATE_PAUSED)
        feeds_.back()->start();
}

void Walk::add_sink(GstPad *pad)
{
    GstElement *sink = gst_element_factory_make("fakesink", nullptr);
    g_object_set(sink, "async", FALSE, nullptr);
    gst_bin_add(GST_BIN(pipeline_), sink);
    g_autoptr(GstPad) sink_pad = gst_element_get_static_pad(sink, "sink");
    gst_pad_link(pad, sink_pad);
    gst_element_sync_state_with_parent(sink);
    sinks_.push_back(sink);
}

void Walk::step()
{
    using Action = void (Walk::*)();
    struct Weighted {
        unsigned weight;
        Action action;
    };
    static constexpr Weighted actions[] = {
        {30, &Walk::feed_something}, {20, &Walk::set_property}, {6, &Walk::read_properties},
        {8, &Walk::change_caps},     {6, &Walk::seek},          {6, &Walk::request_pad},
        {6, &Walk::release_pad},     {6, &Walk::ask},
    };
    take_messages();
    if (state_ < GST_STATE_PAUSED ? chance_.percent(60) : chance_.percent(15)) {
        set_state(chance_.of(
            {GST_STATE_NULL, GST_STATE_READY, GST_STATE_PAUSED, GST_STATE_PLAYING, GST_STATE_PLAYING}));
        return;
    }
    unsigned all = 0;
    for (const Weighted &choice : actions)
        all += choice.weight;
    auto drawn = chance_.below(all);
    for (const auto &[weight, action] : actions) {
        if (drawn < weight) {
            (this->*action)();
            break;
        }
        drawn -= weight;
    }
    if (chance_.percent(40))
        g_usleep(chance_.below(20) * 1000);
}

void Walk::set_state(GstState state)
{
    say(std::string("to ") + gst_element_state_get_name(state));
    if (gst_element_set_state(pipeline_, state) == GST_STATE_CHANGE_FAILURE) {
        failed_ = true;
        state = GST_STATE_NULL;
        gst_element_set_state(pipeline_, state);
    }
    state_ = state;
    for (const auto &feed : feeds_)
        state >= GST_STATE_PAUSED ? feed->start() : feed->stop();
}

void Walk::set_property()
{
    std::vector<GParamSpec *> properties = own_properties(element_);
    std::erase_if(properties, [&](const GParamSpec *property) { return !may_be_set(property, state_); });
    if (properties.empty())
        return;
    GParamSpec *property = chance_.of(properties);
    say(std::string("setting ") + property->name);
    say("set " + set_some_value(element_, property, chance_));
}

void Walk::read_properties()
{
    say("read every property");
    for (GParamSpec *property : own_properties(element_)) {
        if ((property->flags & G_PARAM_READABLE) == 0)
            continue;
        g_auto(GValue) value = G_VALUE_INIT;
        g_value_init(&value, property->value_type);
        g_object_get_property(G_OBJECT(element_), property->name, &value);
    }
}

void Walk::feed_something()
{
    if (is_source()) {
        say("EOS to the pipeline");
        gst_element_send_event(pipeline_, gst_event_new_eos());
        return;
    }
    if (feeds_.empty())
        return;
    const bool well_formed = chance_.percent(75);
    if (chance_.percent(50)) {
        const auto buffers = static_cast<unsigned>(1 + chance_.below(6));
        for (const auto &feed : feeds_)
            say(feed->push(buffers, well_formed));
        return;
    }
    Feed &feed = *chance_.of(feeds_);
    switch (chance_.below(6)) {
    case 0:
        say(feed.gap());
        break;
    case 1:
        say(feed.new_segment());
        break;
    case 2:
        say(feed.name() + ": to be flushed");
        say(feed.flush());
        break;
    case 3:
        if (chance_.percent(40)) {
            say(feed.end());
            break;
        }
        [[fallthrough]];
    default:
        say(feed.push(static_cast<unsigned>(1 + chance_.below(6)), well_formed));
    }
}

void Walk::change_caps()
{
    if (feeds_.empty())
        return;
    if (chance_.percent(25)) {
        say(chance_.of(feeds_)->new_caps(some_shape(chance_), chance_.percent(80)));
        return;
    }
    shape_ = some_shape(chance_);
    for (const auto &feed : feeds_)
        say(feed->new_caps(shape_, true));
}

void Walk::seek()
{
    seek(chance_.percent(70) ? GST_SEEK_FLAG_FLUSH : GST_SEEK_FLAG_NONE);
}

void Walk::seek(GstSeekFlags flags)
{
    if (sinks_.empty())
        return;
    say(flags == GST_SEEK_FLAG_FLUSH ? "flushing seek" : "seek");
    gst_element_send_event(
        chance_.of(sinks_),
        gst_event_new_seek(1.0, GST_FORMAT_TIME, flags, GST_SEEK_TYPE_SET, 0, GST_SEEK_TYPE_NONE, 0));
}

/* By a seek to the start, if it reaches all inputs, else by way of READY. */
void Walk::begin_anew()
{
    set_state(GST_STATE_PLAYING);
    std::vector<unsigned> before;
    for (const auto &feed : feeds_)
        before.push_back(feed->flushing_seeks());
    if (chance_.percent(50))
        seek(GST_SEEK_FLAG_FLUSH);
    bool all = !feeds_.empty();
    for (std::size_t i = 0; i < feeds_.size(); i++)
        all = all && feeds_[i]->flushing_seeks() > before[i];
    if (all)
        return;
    set_state(GST_STATE_READY);
    set_state(GST_STATE_PLAYING);
}

void Walk::request_pad()
{
    std::vector<GstPadTemplate *> templates;
    for (GList *item = gst_element_class_get_pad_template_list(GST_ELEMENT_GET_CLASS(element_)); item;
         item = item->next)
        if (GST_PAD_TEMPLATE_PRESENCE(item->data) == GST_PAD_REQUEST)
            templates.push_back(GST_PAD_TEMPLATE(item->data));
    if (templates.empty())
        return;
    GstPadTemplate *pad_template = chance_.of(templates);
    say(std::string("request ") + GST_PAD_TEMPLATE_NAME_TEMPLATE(pad_template));
    GstPad *pad = gst_element_request_pad(element_, pad_template, nullptr, nullptr);
    if (!pad)
        return;
    requested_.push_back(pad);
    if (GST_PAD_IS_SRC(pad))
        add_sink(pad);
    else
        add_feed(pad);
}

void Walk::release_pad()
{
    if (requested_.empty())
        return;
    GstPad *pad = chance_.of(requested_);
    say(std::string("release ") + GST_PAD_NAME(pad));
    std::erase(requested_, pad);
    g_autoptr(GstPad) peer = gst_pad_get_peer(pad);
    if (GST_PAD_IS_SRC(pad) && peer) {
        gst_pad_unlink(pad, peer);
        GstElement *sink = gst_pad_get_parent_element(peer);
        std::erase(sinks_, sink);
        gst_element_set_state(sink, GST_STATE_NULL);
        gst_bin_remove(GST_BIN(pipeline_), sink);
        gst_object_unref(sink);
    }
    /* The feed goes after the pad: its thread may wait in there. */
    gst_element_release_request_pad(element_, pad);
    std::erase_if(feeds_, [&](const auto &feed) { return feed->sink() == pad; });
    gst_object_unref(pad);
}

void Walk::ask()
{
    say("queries and events against the stream");
    for (GstElement *sink : sinks_) {
        g_autoptr(GstPad) pad = gst_element_get_static_pad(sink, "sink");
        g_autoptr(GstQuery) latency = gst_query_new_latency();
        gst_pad_peer_query(pad, latency);
        gint64 value = 0;
        gst_pad_peer_query_duration(pad, GST_FORMAT_TIME, &value);
        gst_pad_peer_query_position(pad, GST_FORMAT_TIME, &value);
        g_autoptr(GstCaps) caps = gst_pad_peer_query_caps(pad, nullptr);
        gst_pad_push_event(pad, gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW, 2.0, GST_SECOND, 0));
        gst_pad_push_event(pad, gst_event_new_reconfigure());
    }
}

bool Walk::is_source() const
{
    const GList *item = gst_element_class_get_pad_template_list(GST_ELEMENT_GET_CLASS(element_));
    for (; item; item = item->next)
        if (GST_PAD_TEMPLATE_DIRECTION(item->data) == GST_PAD_SINK)
            return false;
    return true;
}

void Walk::take_messages()
{
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_);
    while (GstMessage *message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR)) {
        failed_ = true;
        g_autoptr(GError) error = nullptr;
        gst_message_parse_error(message, &error, nullptr);
        say(std::string("(error: ") + error->message + ")");
        gst_message_unref(message);
    }
}

bool Walk::finishes()
{
    take_messages();
    if (failed_ || sinks_.empty() || feeds_.empty() != is_source())
        return true;
    begin_anew();
    if (failed_) /* it did not start again, and on the way to NULL the bus lost the error */
        return true;
    for (const auto &feed : feeds_) {
        say("last round: " + feed->new_caps(shape_, true));
        say("last round: " + feed->push(6, true));
        say("last round: " + feed->end());
    }
    if (feeds_.empty()) {
        say("last round: EOS to the pipeline");
        gst_element_send_event(pipeline_, gst_event_new_eos());
    }
    g_autoptr(GstBus) bus = gst_element_get_bus(pipeline_);
    g_autoptr(GstMessage) message = gst_bus_timed_pop_filtered(
        bus, 50 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    return failed_ || message;
}

bool Walk::leaves()
{
    if (!pipeline_)
        return true;
    set_state(GST_STATE_NULL);
    say("let go");
    while (!requested_.empty())
        release_pad();
    feeds_.clear();
    GWeakRef watched;
    g_weak_ref_init(&watched, element_);
    gst_clear_object(&pipeline_);
    bool gone = false;
    for (int i = 0; i < 100 && !gone; i++) {
        GstElement *held = GST_ELEMENT(g_weak_ref_get(&watched));
        gone = !held;
        gst_clear_object(&held);
        if (!gone)
            g_usleep(50'000);
    }
    g_weak_ref_clear(&watched);
    return gone;
}

} // namespace dff::walk
