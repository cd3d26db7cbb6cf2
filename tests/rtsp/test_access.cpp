/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
/* Who is let in. */
#include "receiver.h"
#include "server_process.h"

#include <filesystem>
#include <fstream>
#include <gio/gio.h>
#include <gtest/gtest.h>

namespace {

const std::string quick_depth =
    "videotestsrc is-live=true ! video/x-raw,format=GRAY16_LE,width=32,height=32,framerate=20/1 ! identity "
    "name=depth";

std::string receive(const std::string &url)
{
    return "rtspsrc latency=100 protocols=tcp tls-validation-flags=0 location=" + url +
           " ! appsink name=sink sync=false";
}

/* A folder that goes with the test. */
class Folder {
public:
    Folder()
    {
        g_autofree char *path = g_dir_make_tmp("dff-rtsp-XXXXXX", nullptr);
        path_ = path;
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;

    std::string file(const std::string &name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

TEST(Access, accounts_of_a_file_and_of_the_command_line_are_let_in)
{
    const Folder folder;
    std::ofstream(folder.file("accounts")) << "[accounts]\nanna=se:cret\n";
    ServerProcess server(quick_depth, {"--accounts", folder.file("accounts"), "--account", "bert:other"});

    EXPECT_NE(Receiver(receive(server.url("/depth", "anna:se%3Acret"))).next(), nullptr);
    EXPECT_NE(Receiver(receive(server.url("/depth", "bert:other"))).next(), nullptr);
}

TEST(Access, a_wrong_password_is_refused)
{
    ServerProcess server(quick_depth, {"--account", "anna:secret"});

    for (const char *account : {"anna:wrong", "bert:secret", ""}) {
        Receiver client(receive(server.url("/depth", account)));
        EXPECT_NE(client.error().find("Unauthorized"), std::string::npos) << account;
    }
    EXPECT_EQ(server.count_in_log("The source is started"), 0U);
}

/* What the server says of how to show who one is: the first answer to somebody with these headers. */
std::string answer(const ServerProcess &server, const std::string &headers = "")
{
    const std::string url = server.url("/depth"), host = url.substr(7, url.rfind('/') - 7);
    g_autoptr(GSocketClient) client = g_socket_client_new();
    g_autoptr(GSocketConnection) connection =
        g_socket_client_connect_to_host(client, host.c_str(), 0, nullptr, nullptr);
    if (!connection)
        return "no connection to " + host;
    const std::string request = "DESCRIBE " + url + " RTSP/1.0\r\nCSeq: 1\r\n" + headers + "\r\n";
    g_output_stream_write_all(g_io_stream_get_output_stream(G_IO_STREAM(connection)), request.data(),
                              request.size(), nullptr, nullptr, nullptr);
    char text[4096] = {};
    g_input_stream_read(g_io_stream_get_input_stream(G_IO_STREAM(connection)), text, sizeof text - 1, nullptr,
                        nullptr);
    return text;
}

TEST(Access, passwords_go_in_the_clear_only_where_that_was_asked_for)
{
    const std::string basic = "Authorization: Basic YW5uYTpzZWNyZXQ=\r\n"; /* anna:secret */
    {
        ServerProcess server(quick_depth, {"--account", "anna:secret"});
        EXPECT_NE(answer(server).find("WWW-Authenticate: Digest"), std::string::npos) << answer(server);
        EXPECT_EQ(answer(server).find("WWW-Authenticate: Basic"), std::string::npos) << answer(server);
        EXPECT_NE(answer(server, basic).find("401 Unauthorized"), std::string::npos) << answer(server, basic);
    }
    ServerProcess server(quick_depth, {"--account", "anna:secret", "--basic"});
    EXPECT_NE(answer(server).find("WWW-Authenticate: Digest"), std::string::npos) << answer(server);
    EXPECT_NE(answer(server).find("WWW-Authenticate: Basic"), std::string::npos) << answer(server);
    EXPECT_NE(answer(server, basic).find("200 OK"), std::string::npos) << answer(server, basic);
}

TEST(Access, one_client_too_many_is_told_so)
{
    ServerProcess server(quick_depth, {"--max-clients", "2"});
    Receiver first(receive(server.url("/depth")));
    Receiver second(receive(server.url("/depth")));
    ASSERT_NE(first.next(), nullptr);
    ASSERT_NE(second.next(), nullptr);

    {
        Receiver third(receive(server.url("/depth")));
        EXPECT_NE(third.error().find("503"), std::string::npos);
    }
    EXPECT_NE(first.next(), nullptr);
}

TEST(Access, a_certificate_makes_it_rtsps)
{
    const Folder folder;
    const std::string pem = folder.file("server.pem");
    const std::string command =
        "openssl req -x509 -newkey rsa:2048 -nodes -subj /CN=localhost -days 2 -keyout " + pem +
        ".key -out " + pem + ".crt 2>/dev/null && cat " + pem + ".key " + pem + ".crt >" + pem;
    ASSERT_EQ(std::system(command.c_str()), 0);
    ServerProcess server(quick_depth, {"--certificate", pem, "--account", "anna:secret"});

    EXPECT_EQ(server.url("/depth").rfind("rtsps://", 0), 0U);
    EXPECT_NE(Receiver(receive(server.url("/depth", "anna:secret"))).next(), nullptr);
    EXPECT_NE(Receiver(receive(server.url("/depth", "anna:wrong"))).error(), "");
}

} // namespace
