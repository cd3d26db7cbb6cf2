/* SPDX-License-Identifier: LGPL-2.1-or-later
 * Copyright (C) 2026 the gst-plugins-dff authors */
#include "options.h"

#include <gst/gst.h>
#include <stdexcept>

namespace dff {

namespace {

struct Values {
    gchar *board = nullptr, *sheet = nullptr, *output = nullptr, *check = nullptr, *points = nullptr,
          *lens = nullptr, *profile = nullptr, *like = nullptr, *plots = nullptr;
    gchar **recordings = nullptr, **sources = nullptr;
    gint boards = 0;

    ~Values()
    {
        for (gchar *text : {board, sheet, output, check, points, lens, profile, like, plots})
            g_free(text);
        g_strfreev(recordings);
        g_strfreev(sources);
    }
};

constexpr char summary[] = "Finds out what a camera and its lens are, from sweeps that show a printed "
                           "chessboard near and far, in all parts\n"
                           "of the picture and tilted to all sides, and writes a file for every calibration "
                           "property. Print the sheet, then:\n\n"
                           "  dff-calibrate --sheet board.svg\n"
                           "  dff-calibrate --source \"lenssweepsrc\"\n"
                           "  dff-calibrate --recording near.gdp --recording far.gdp ...\n"
                           "  dff-calibrate --points 120=2.0,200=0.9,310=0.5 --output lens.yml\n"
                           "  dff-calibrate --check calibration.yml --recording today.gdp";

std::string quoted(const gchar *path)
{
    g_autofree gchar *escaped = g_strescape(path, nullptr);
    return std::string("\"") + escaped + "\"";
}

void take(const Values &values, Options &options)
{
    for (gchar **file = values.recordings; file && *file; file++)
        options.sources.push_back("filesrc location=" + quoted(*file) + " ! gdpdepay ! dffmetadepay");
    for (gchar **source = values.sources; source && *source; source++)
        options.sources.emplace_back(*source);
    if (values.board) {
        const auto board = Board::parse(values.board);
        if (!board)
            throw std::invalid_argument(
                std::string("--board ") + values.board +
                " is none: give squares in a row and a column, 4 to 40, and millimetres of one, "
                "as 10x7x25");
        options.board = *board;
    }
    options.sheet = values.sheet ? values.sheet : options.sheet;
    options.check = values.check ? values.check : options.check;
    options.points = values.points ? values.points : options.points;
    if (!options.points.empty()) /* no lens profile takes the place of a calibration that nobody named */
        options.output = "lens.yml";
    options.output = values.output ? values.output : options.output;
    options.lens = values.lens ? values.lens : options.lens;
    options.profile = values.profile ? values.profile : options.profile;
    if (values.like)
        options.like = values.like;
    options.plots = values.plots ? values.plots : options.plots;
    if (values.boards < 0 || values.boards > 1000)
        throw std::invalid_argument("--boards is 1 to 1000");
    options.boards = values.boards ? static_cast<unsigned>(values.boards) : options.boards;
    if (options.sources.empty() && options.sheet.empty() && options.points.empty())
        throw std::invalid_argument(
            "Nothing to look at: give --source or --recording, --points or --sheet; --help tells more");
    if (!options.profile.empty() && (options.sources.empty() || !options.check.empty()))
        throw std::invalid_argument(
            "--profile is of boards that are seen: give --source or --recording with it, and not --check");
    if (options.like && options.profile.empty())
        throw std::invalid_argument("--like is for --profile, the file to write");
    if (!options.plots.empty() && (options.sources.empty() || !options.check.empty()))
        throw std::invalid_argument(
            "--plots draws what is found: give --source or --recording with it, and not --check");
}

} // namespace

Options parse_options(int argc, char **argv)
{
    Values values;
    const GOptionEntry entries[] = {
        {"board", 0, 0, G_OPTION_ARG_STRING, &values.board,
         "Squares in a row and in a column, and the side of one in millimetres (10x7x25)", "CxRxMM"},
        {"sheet", 0, 0, G_OPTION_ARG_FILENAME, &values.sheet,
         "Write the board as SVG, to print at its own size", "FILE"},
        {"recording", 0, 0, G_OPTION_ARG_FILENAME_ARRAY, &values.recordings,
         "A recording of planes by dffmetapay ! gdppay; may be given many times", "FILE"},
        {"source", 0, 0, G_OPTION_ARG_STRING_ARRAY, &values.sources,
         "A pipeline that ends in labelled planes; may be given many times", "PIPELINE"},
        {"output", 'o', 0, G_OPTION_ARG_FILENAME, &values.output,
         "The file to write (calibration.yml, with --points lens.yml)", "FILE"},
        {"check", 0, 0, G_OPTION_ARG_FILENAME, &values.check,
         "Write nothing: measure whether this file still fits", "FILE"},
        {"plots", 0, 0, G_OPTION_ARG_FILENAME, &values.plots,
         "Draw what was found and what is left over, as SVG", "FILE"},
        {"points", 0, 0, G_OPTION_ARG_STRING, &values.points,
         "Look at nothing: write a lens profile of distances that a tape measured, as "
         "120=2.0,200=0.9,310=0.5",
         "POSITION=METRES,..."},
        {"profile", 0, 0, G_OPTION_ARG_FILENAME, &values.profile,
         "Write a lens profile too, of what the lens was told for the planes", "FILE"},
        {"like", 0, 0, G_OPTION_ARG_FILENAME, &values.like,
         "Profile of the liquid lens that was swept, whose driver and times --profile takes over", "FILE"},
        {"lens", 0, 0, G_OPTION_ARG_STRING, &values.lens, "The name of the lens in its profile", "NAME"},
        {"boards", 0, 0, G_OPTION_ARG_INT, &values.boards, "Poses of the board after which to end (12)", "N"},
        {nullptr, 0, 0, G_OPTION_ARG_NONE, nullptr, nullptr, nullptr}};
    g_autoptr(GOptionContext) context = g_option_context_new(nullptr);
    g_autoptr(GError) error = nullptr;
    g_option_context_set_summary(context, summary);
    g_option_context_add_main_entries(context, entries, nullptr);
    g_option_context_add_group(context, gst_init_get_option_group());
    if (!g_option_context_parse(context, &argc, &argv, &error))
        throw std::invalid_argument(error->message);
    if (argc > 1)
        throw std::invalid_argument(std::string(argv[1]) + " is no option; --help tells which there are");
    Options options;
    take(values, options);
    return options;
}

} // namespace dff
