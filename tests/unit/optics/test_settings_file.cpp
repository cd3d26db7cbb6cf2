/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "optics/settings_file.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <stdexcept>
#include <sys/stat.h>
#include <unistd.h>

using dff::FileEntries;

namespace {

/* A file with this text, gone afterwards. */
class TextFile {
public:
    explicit TextFile(const std::string &text, const std::string &ending = ".yml")
        : path(testing::TempDir() + "settings" + std::to_string(getpid()) + ending)
    {
        std::ofstream(path, std::ios::binary) << text;
    }
    ~TextFile() { std::filesystem::remove(path); }

    TextFile(const TextFile &) = delete;
    TextFile &operator=(const TextFile &) = delete;

    const std::string path;
};

std::string yaml(const std::string &lines)
{
    return "%YAML:1.0\n---\n" + lines;
}

std::string repeated(const std::string &text, unsigned times)
{
    std::string all;
    for (unsigned k = 0; k < times; k++)
        all += text;
    return all;
}

/* What is said of a file, without its name, or nothing if `use` takes it. */
template <typename Use> std::string fault_of(const std::string &path, Use use)
{
    const std::string start = "The file " + path + " cannot be used: ";
    try {
        use(FileEntries("The file", path));
    } catch (const std::runtime_error &error) {
        EXPECT_EQ(std::string(error.what()).substr(0, start.size()), start);
        return std::string(error.what()).substr(start.size());
    }
    return "";
}

std::string fault_of_path(const std::string &path)
{
    return fault_of(path, [](const FileEntries &) {});
}

template <typename Use> std::string fault_of_lines(const std::string &lines, Use use)
{
    return fault_of(TextFile(yaml(lines)).path, use);
}

std::string fault_of_number(const std::string &value, dff::Range range)
{
    return fault_of_lines("a: " + value + "\n", [&](const FileEntries &e) { e.number("a", range); });
}

} // namespace

TEST(SettingsFile, is_read_in_three_languages)
{
    const char *const texts[] = {
        "%YAML:1.0\n---\na: 1.5\nb: { c: [ 1, 2. ] }\n",
        R"({"a": 1.5, "b": {"c": [1, 2.0]}})",
        "<?xml version=\"1.0\"?>\n<opencv_storage><a>1.5</a><b><c>1 2.</c></b></opencv_storage>\n",
    };
    for (const char *text : texts) {
        const TextFile file(text);
        const FileEntries entries("The file", file.path);
        EXPECT_EQ(entries.number("a", {}), 1.5) << text;
        EXPECT_EQ(entries.entries("b").numbers("c", 2, 2, {}), (std::vector{1.0, 2.0})) << text;
    }
}

TEST(SettingsFile, nesting_that_overflows_the_parser_is_refused_in_each_language)
{
    for (const unsigned depth : {3000U, 100'000U, 300'000U}) {
        const std::string texts[] = {
            yaml("a: " + repeated("[", depth)),
            yaml("a: " + repeated("{b: ", depth)),
            yaml("a:\n" + repeated("- ", depth) + "1\n"),
            yaml("a:\n  " + repeated("-\t", depth) + "1\n"),
            yaml(repeated("a: ", depth) + "1\n"),
            yaml(repeated("a:", depth) + "1\n"),
            yaml("a: " + repeated("[ #]\n", depth)),
            R"({"a": )" + repeated("[", depth),
            repeated(R"({"a": )", depth),
            "<?xml version=\"1.0\"?>\n<opencv_storage>" + repeated("<a>", depth) + "</opencv_storage>",
        };
        for (const std::string &text : texts) {
            const std::string fault = fault_of_path(TextFile(text).path);
            EXPECT_TRUE(fault == "it has more than 2000 entries and lists" ||
                        fault == "it has more than 1 MiB")
                << depth << " times, as " << text.substr(0, 60) << ": " << fault;
        }
    }
}

TEST(SettingsFile, nesting_up_to_the_bound_does_no_harm)
{
    for (const char *const mark : {"[", "{a: ", "a: ", "- "}) {
        const std::string lines = "a: " + repeated(mark, 990) + "\n";
        EXPECT_EQ(fault_of_path(TextFile(yaml(lines)).path).find("more than"), std::string::npos) << mark;
    }
}

TEST(SettingsFile, what_is_no_such_file_is_told_at_once)
{
    EXPECT_EQ(fault_of_path("/nonexistent.yml"), "it cannot be opened: No such file or directory");
    EXPECT_EQ(fault_of_path("/"), "it is not a file");
    EXPECT_EQ(fault_of_path("/dev/zero"), "it is not a file");
    const std::string pipe = testing::TempDir() + "settings-pipe" + std::to_string(getpid());
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(fault_of_path(pipe), "it is not a file") << "nobody writes into it";
    std::filesystem::remove(pipe);

    for (const char c : {'\0', '\1', '\x1b', '\x7f'})
        EXPECT_EQ(fault_of_path(TextFile(yaml("a: ") + c).path),
                  "it has other characters than those of a text");

    const std::string unknown = "it is neither YAML (with a first line %YAML:1.0) nor JSON nor XML";
    for (const char *const text : {"", "\n", " \r\n\t"})
        EXPECT_EQ(fault_of_path(TextFile(text).path), "it is empty");
    for (const char *const text : {"a: 1\n", "\x8b\x88", "%YAML:1.0\n---\na: [",
                                   "%YAML:1.0\n---\na:\n   -\n      dx: 3.0\n      :\n", "{\"a\": 1"})
        EXPECT_EQ(fault_of_path(TextFile(text).path).substr(0, unknown.size()), unknown) << text;
    EXPECT_EQ(fault_of_path(TextFile("[ 1, 2 ]").path).substr(0, unknown.size()), unknown);
    EXPECT_EQ(fault_of_path(TextFile(std::string(2 << 20, ' ')).path), "it has more than 1 MiB");
}

TEST(SettingsFile, the_parser_sees_one_yaml_document_or_it_would_not_come_back)
{
    for (const char *const text : {
             "%YAML",
             "%YAML:1.0\n",
             "%YAML:1.0\n---\n# nothing\n",
             "%YAML:1.0\n---\n- 1\n- 2\n",
             "%YAML:1.0\n---\n{ a: 1 }\n",
             "%YAML:1.0\n--- { a: 1 }\n",
             "%YAML:1.\n---r:0\n---%\n-",
             "%YAML:1.0\n---\n   a: 1\n123-",
             "%YAML:1.0\n---\na: 1\n...\n-",
             "%YAML:1.0\n---\na: 1\n---\n-",
             "%YAML:1.0\n---\na: 1\n%YAML:1.0\n",
         })
        EXPECT_EQ(
            fault_of_path(TextFile(text).path),
            "it is not a single YAML document, the names of whose entries begin at the line's beginning")
            << text;
    for (const char *const text :
         {"%YAML:1.0\n---\na: 1\n", "%YAML:1.0\na: 1\n", "%YAML:1.0\r\n---\r\n\r\n# a\r\n  # b\r\na: 1\r\n",
          "\xef\xbb\xbf%YAML:1.0\n---\na: 1\n", "%YAML:1.0\n--- \n\na: 1\nb:\n   - 2\n"})
        EXPECT_EQ(FileEntries("The file", TextFile(text).path).number("a", {}), 1.0) << text;
}

TEST(SettingsFile, xml_that_is_cut_is_refused)
{
    const std::string whole =
        "<?xml version=\"1.0\"?>\n<opencv_storage>\n<!-- a -->\n<a>1</a>\n</opencv_storage>\n";
    EXPECT_EQ(FileEntries("The file", TextFile(whole).path).number("a", {}), 1.0);
    for (size_t size = 5; size < whole.size() - 1; size++)
        EXPECT_EQ(
            fault_of_path(TextFile(whole.substr(0, size)).path),
            "it is not a whole XML document, with ?> in its first line and </opencv_storage> at its end")
            << size;
    EXPECT_NE(fault_of_path(TextFile("<?xml ve=\n</opencv_storage>").path), "");
    EXPECT_NE(fault_of_path(TextFile("<?xml version=\"1.0\"?>\n<!-- </opencv_storage>").path), "");
}

TEST(SettingsFile, binary_data_is_refused_in_each_language)
{
    for (const char *const text :
         {"%YAML:1.0\n---\na: !!binary |\n  AAA\n", "%YAML:1.0\n---\na: !<tag:yaml.org,2002:binary> AAA\n",
          "{\"a\": \"$base64$AAA\"}",
          "<?xml version=\"1.0\"?>\n<opencv_storage><a type_id='binary'>AAA</a></opencv_storage>"})
        EXPECT_EQ(fault_of_path(TextFile(text).path), "it has binary data; write numbers as text") << text;
}

TEST(SettingsFile, numbers_are_finite_and_in_their_range_which_is_told)
{
    EXPECT_EQ(fault_of_number("5", {0.0, 10.0}), "");
    EXPECT_EQ(fault_of_number("0", {0.0, 10.0}), "");
    EXPECT_EQ(fault_of_number("10.", {0.0, 10.0}), "");
    EXPECT_EQ(fault_of_number("10.5", {0.0, 10.0}), "a is 10.5 and must be 0 to 10");
    EXPECT_EQ(fault_of_number("-1", {0.0}), "a is -1 and must be 0 or more");
    EXPECT_EQ(fault_of_number("1e300", {.most = 1e6}), "a is 1e+300 and must be 1000000 or less");
    EXPECT_EQ(fault_of_number(".nan", {0.0, 10.0}), "a is nan and must be 0 to 10");
    EXPECT_EQ(fault_of_number(".inf", {}), "a is inf and must be finite");
    EXPECT_EQ(fault_of_number("-.inf", {}), "a is -inf and must be finite");
    EXPECT_EQ(fault_of_number("wide", {}), "a is not a number");
    EXPECT_EQ(fault_of_number("[ 1 ]", {}), "a is not a number");
    EXPECT_EQ(fault_of_number("{ b: 1 }", {}), "a is not a number");
}

TEST(SettingsFile, entries_of_another_type_are_told_by_name)
{
    EXPECT_EQ(fault_of_lines("b: 1\n", [](const auto &e) { e.number("a", {}); }), "a is missing");
    EXPECT_EQ(fault_of_lines("a: 1.5\n", [](const auto &e) { e.whole_number("a", 1, 9); }),
              "a is 1.5 and must be a whole number");
    EXPECT_EQ(fault_of_lines("a: 1\n", [](const auto &e) { e.text("a"); }), "a is not a text");
    EXPECT_EQ(fault_of_lines("a: 1\n", [](const auto &e) { e.entries("a"); }), "a has no named entries");
    EXPECT_EQ(fault_of_lines("a: 1\n", [](const auto &e) { e.numbers("a", 2, 9, {}); }),
              "a must be a list of 2 to 9 numbers");
    EXPECT_EQ(fault_of_lines("a: [ 1, x ]\n", [](const auto &e) { e.numbers("a", 2, 9, {}); }),
              "a[1] is not a number");
    EXPECT_EQ(fault_of_lines("a: [ { b: 1 }, 2 ]\n", [](const auto &e) { e.list("a", 9); }),
              "a[1] has no named entries");
    EXPECT_EQ(fault_of_lines("a: [ { b: 1 }, { b: 1 } ]\n", [](const auto &e) { e.list("a", 1); }),
              "a must be a list of 1 to 1");
    EXPECT_EQ(fault_of_lines("a: [ { b: 1 }, { c: 1 } ]\n",
                             [](const auto &e) { e.list("a", 2)[1].number("b", {}); }),
              "a[1].b is missing");
}

TEST(SettingsFile, matrices_have_as_many_numbers_as_they_say)
{
    const auto matrix = [](const std::string &rows, const std::string &columns, const std::string &type,
                           const std::string &data) {
        return fault_of_lines("a: !!opencv-matrix\n   rows: " + rows + "\n   cols: " + columns +
                                  "\n   dt: " + type + "\n   data: [ " + data + " ]\n",
                              [](const FileEntries &e) { e.matrix("a", 3, 3); });
    };
    EXPECT_EQ(matrix("1", "2", "d", "1, 2"), "");
    EXPECT_EQ(matrix("1", "2", "\"2f\"", "1, 2, 3, 4"),
              "a.dt is \"2f\" and must be \"d\" or another type of one number");
    EXPECT_EQ(matrix("1", "2", "d", "1, 2, 3"), "a.data must be a list of 2 numbers");
    EXPECT_EQ(matrix("100000", "100000", "d", "1"), "a.rows is 100000 and must be 1 to 3");
    EXPECT_EQ(matrix("-1", "2", "d", "1, 2"), "a.rows is -1 and must be 1 to 3");
    EXPECT_EQ(matrix("1", "2", "d", "1, .nan"), "a.data[1] is nan and must be finite");
    EXPECT_EQ(fault_of_lines("a: 1\n", [](const auto &e) { e.matrix("a", 3, 3); }), "a has no named entries");
}
