/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* The server's parts, without a network. */
#include "back_off.h"
#include "depth_attributes.h"
#include "server.h"
#include "warm_up.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace {

using std::chrono::milliseconds;

TEST(BackOff, doubles_up_to_ten_seconds_and_starts_again)
{
    dff::BackOff back_off;
    EXPECT_EQ(back_off.next(), milliseconds(500));
    EXPECT_EQ(back_off.next(), milliseconds(1000));
    for (int k = 0; k < 10; k++)
        back_off.next();
    EXPECT_EQ(back_off.next(), milliseconds(10000));
    back_off.succeeded();
    EXPECT_EQ(back_off.next(), milliseconds(500));
}

TEST(DepthAttributes, what_is_not_known_is_left_out)
{
    GstDepthInfo info;
    gst_depth_info_init(&info);
    info.scale = 0.1;
    const auto attributes = dff::depth_attributes(info);
    ASSERT_EQ(attributes.size(), 3U);
    EXPECT_EQ(attributes[0].second, "index");
    EXPECT_EQ(std::stod(attributes[1].second), 0.1);
}

TEST(DepthAttributes, intrinsics_are_nine_numbers)
{
    GstDepthInfo info;
    gst_depth_info_init(&info);
    info.near = 5;
    info.far = 0;
    info.has_intrinsics = TRUE;
    info.fx = 600.5;
    info.distortion[4] = -0.25;
    const auto attributes = dff::depth_attributes(info);
    EXPECT_EQ(attributes.back().first, "depth-intrinsics");
    EXPECT_EQ(attributes.back().second, "600.5 0 0 0 0 0 0 0 -0.25");
}

std::set<std::string> outputs_of(const std::string &launch)
{
    return dff::SourcePipeline(launch).outputs();
}

/* captures.txt: sources that dff-studio takes and refuses likewise. */
TEST(SourcePipeline, takes_and_refuses_what_the_studio_does)
{
    std::ifstream file(std::getenv("DFF_CAPTURES"));
    int lines = 0;
    for (std::string line; std::getline(file, line);) {
        const size_t bar = line.find('|');
        if (line.front() == '#')
            continue;
        ASSERT_NE(bar, std::string::npos) << line;
        const std::string launch = line.substr(bar + 1);
        std::istringstream words(line.substr(0, bar));
        std::set<std::string> outputs{std::istream_iterator<std::string>(words), {}};
        outputs.erase("motion"); /* the studio alone shows it */
        if (outputs.empty())
            EXPECT_THROW(outputs_of(launch), std::invalid_argument) << launch;
        else
            EXPECT_EQ(outputs_of(launch), outputs) << launch;
        lines++;
    }
    EXPECT_GT(lines, 15);
}

using std::chrono::seconds;
using std::chrono::steady_clock;

TEST(WarmUp, lasts_until_each_output_has_given_a_frame)
{
    const auto start = steady_clock::now();
    dff::warm_up("videotestsrc is-live=true ! video/x-raw,framerate=20/1 ! identity name=aif "
                 "videotestsrc ! video/x-raw,format=GRAY16_LE ! identity sleep-time=300000 name=depth",
                 seconds(60));
    EXPECT_GE(steady_clock::now() - start, milliseconds(300));
    EXPECT_LT(steady_clock::now() - start, seconds(50));
}

TEST(WarmUp, a_source_that_fails_ends_or_is_silent_is_not_waited_for)
{
    const auto start = steady_clock::now();
    dff::warm_up("filesrc location=/no/such/file ! identity name=depth", seconds(60));
    dff::warm_up("videotestsrc num-buffers=0 ! identity name=depth", seconds(60));
    EXPECT_LT(steady_clock::now() - start, seconds(50));
    dff::warm_up("videotestsrc is-live=true ! valve drop=true ! identity name=depth", seconds(1));
    EXPECT_LT(steady_clock::now() - start, seconds(58));
}

TEST(WarmUp, a_depth_that_is_none_is_refused_by_name)
{
    try {
        dff::warm_up("videotestsrc is-live=true ! video/x-raw,format=I420 ! identity name=depth",
                     seconds(30));
        FAIL() << "taken for depth";
    } catch (const std::invalid_argument &error) {
        EXPECT_NE(std::string(error.what()).find("depth"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("GRAY16_LE"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("I420"), std::string::npos) << error.what();
    }
    EXPECT_NO_THROW(dff::warm_up("videotestsrc ! video/x-raw,format=GRAY16_LE ! identity name=depth "
                                 "videotestsrc ! video/x-raw,format=RGB ! identity name=aif",
                                 seconds(30)));
}

dff::ServerOptions parse(std::vector<std::string> arguments)
{
    arguments.insert(arguments.begin(), "dff-rtsp-server");
    std::vector<char *> pointers;
    for (std::string &argument : arguments)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    return dff::parse_options(static_cast<int>(arguments.size()), pointers.data());
}

TEST(ServerOptions, nonsense_is_refused)
{
    EXPECT_THROW(parse({"--no-such-option"}), std::invalid_argument);
    EXPECT_THROW(parse({"stray"}), std::invalid_argument);
    EXPECT_THROW(parse({"--port", "70000"}), std::invalid_argument);
    EXPECT_THROW(parse({"--max-clients", "0"}), std::invalid_argument);
    EXPECT_THROW(parse({"--max-clients", "2147483647"}), std::invalid_argument); /* INT_MAX */
    EXPECT_THROW(parse({"--account", "no-password"}), std::invalid_argument);
    EXPECT_THROW(parse({"--account", ":secret"}), std::invalid_argument);
    EXPECT_THROW(parse({"--accounts", "/no/such/file"}), std::invalid_argument);
}

TEST(ServerOptions, the_default_source_gives_every_output)
{
    const dff::ServerOptions options = parse({});
    EXPECT_EQ(options.port, 8554);
    EXPECT_EQ(outputs_of(options.launch), (std::set<std::string>{"aif", "depth", "planes", "uncertainty"}));
}

TEST(Server, says_why_it_cannot_listen_or_encrypt)
{
    dff::ServerOptions options;
    options.address = "127.0.0.1";
    options.port = 0;
    const auto capture = std::make_shared<dff::Capture>("videotestsrc name=depth");
    options.certificate = "/no/such/file";
    EXPECT_THROW(dff::Server(options, capture), std::invalid_argument);
    options.certificate.clear();

    const dff::Server first(options, capture);
    const std::string url = first.urls().at(0);
    const size_t colon = url.rfind(':');
    options.port = std::stoi(url.substr(colon + 1));
    EXPECT_THROW(dff::Server(options, capture), std::runtime_error);
}

TEST(Server, a_certificate_without_its_key_is_refused_at_the_start)
{
    g_autofree char *folder = g_dir_make_tmp("dff-rtsp-XXXXXX", nullptr);
    dff::ServerOptions options;
    options.address = "127.0.0.1";
    options.port = 0;
    options.certificate = std::string(folder) + "/cert.pem";
    const std::string command = std::string("cd ") + folder +
                                " && openssl req -x509 -newkey rsa:2048 -nodes -subj /CN=x -days 2 -keyout "
                                "key.pem -out cert.pem 2>/dev/null && cat key.pem cert.pem >both.pem";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const auto capture = std::make_shared<dff::Capture>("videotestsrc name=depth");
    try {
        const dff::Server server(options, capture);
        ADD_FAILURE() << "it starts";
    } catch (const std::invalid_argument &error) {
        EXPECT_NE(std::string(error.what()).find("private key"), std::string::npos) << error.what();
    }
    options.certificate = std::string(folder) + "/both.pem";
    EXPECT_NO_THROW(dff::Server(options, capture));
    std::filesystem::remove_all(folder);
}

/* The namespace of the tests has the loopback only. */
TEST(Server, its_addresses_can_be_typed)
{
    const auto capture = std::make_shared<dff::Capture>("videotestsrc name=depth");
    for (const auto &[address, host] : {std::pair("127.0.0.1", "127.0.0.1"), std::pair("::1", "[::1]"),
                                        std::pair("0.0.0.0", "localhost"), std::pair("::", "localhost")}) {
        dff::ServerOptions options;
        options.address = address;
        options.port = 0;
        const std::string url = dff::Server(options, capture).urls().at(0);
        EXPECT_EQ(url.rfind(std::string("rtsp://") + host + ":", 0), 0U) << url;
    }
}

} // namespace
