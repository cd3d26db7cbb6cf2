/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* test_walk PLUGIN: every element of the plug-in through sequences of whatever an application may do to it,
 * drawn by seeds: states, properties at their ends, caps, flushes, seeks, gaps, ends, pads that come and go.
 * No crash, no hang, no CRITICAL, nothing left behind; and an end or an error comes out where streams end.
 *
 * DFF_SEQUENCES is the number of sequences of each element, DFF_SEED the first seed. A sequence that fails is
 * printed and runs again by its seed: DFF_SEQUENCES=1 DFF_SEED=n test_walk PLUGIN --gtest_filter='*element*'.
 */
#include "../rig/source/own_network.h"
#include "walk.h"

#include <gtest/gtest.h>

namespace {

using dff::walk::Story;
using dff::walk::Walk;

std::uint64_t number(const char *variable, std::uint64_t fallback)
{
    const char *value = std::getenv(variable);
    return value ? std::stoull(value) : fallback;
}

void walk(const std::string &factory, std::uint64_t seed)
{
    Story story(factory + ", seed " + std::to_string(seed));
    Walk walk(factory, seed, story);
    const unsigned steps = 8 + seed % 17;
    for (unsigned i = 0; i < steps; i++)
        walk.step();
    EXPECT_TRUE(walk.finishes()) << "neither an end nor an error came out:\n" << story.text();
    EXPECT_TRUE(walk.leaves()) << "somebody still holds the element:\n" << story.text();
    for (const std::string &line : Story::complaints())
        ADD_FAILURE() << line << "\n" << story.text();
}

class ElementWalk : public testing::Test {
public:
    explicit ElementWalk(std::string factory) : factory_(std::move(factory)) {}
    void TestBody() override
    {
        const std::uint64_t first = number("DFF_SEED", 1);
        const std::uint64_t sequences = number("DFF_SEQUENCES", 12);
        for (std::uint64_t seed = first; seed < first + sequences && !HasFailure(); seed++)
            walk(factory_, seed);
    }

private:
    std::string factory_;
};

void register_elements(const char *plugin)
{
    GList *features = gst_registry_get_feature_list_by_plugin(gst_registry_get(), plugin);
    for (GList *item = features; item; item = item->next) {
        if (!GST_IS_ELEMENT_FACTORY(item->data))
            continue;
        const std::string name = GST_OBJECT_NAME(item->data);
        testing::RegisterTest("Walk", name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                              [name]() -> testing::Test * { return new ElementWalk(name); });
    }
    gst_plugin_feature_list_free(features);
}

} // namespace

int main(int argc, char **argv)
{
    testing::InitGoogleTest(&argc, argv);
    /* Cameras are looked for by broadcast. */
    if (!dff::enter_own_network()) {
        std::puts("A network namespace takes root: skipped");
        return 77;
    }
    gst_init(&argc, &argv);
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s PLUGIN\n", argv[0]);
        return 2;
    }
    register_elements(argv[1]);
    return RUN_ALL_TESTS();
}
