#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <numeric>
#include <set>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/linear/linear_backend.h>

#include "command.h"
#include "manual.h"

namespace {

extern "C" void interrupted(int) {
    beltrami::remove_temporaries_from_signal_handler();
    _exit(130);
}

/// A standard stream that is closed would give its number to the first file that is opened, and words meant for it
/// would go into that file. Standard output is then one that cannot be written, standard error one that takes
/// everything.
void occupy_closed_streams() {
    const auto closed = [](int descriptor) { return ::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF; };
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (closed(descriptor)) ::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

int edit_distance(const std::string& a, const std::string& b) {
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        int diagonal = row[0]++;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int change = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

/// The word of @p known nearest to @p word, or nothing if none is near.
std::string nearest(const std::string& word, const std::set<std::string>& known) {
    std::string best;
    int least = std::max(2, static_cast<int>(word.size()) / 3) + 1;
    for (const std::string& candidate : known)
        if (const int distance = edit_distance(word, candidate); distance < least) {
            least = distance;
            best = candidate;
        }
    return best;
}

/// Says what an unknown argument may have meant.
std::string suggestion(const CLI::App& app) {
    const CLI::App* chosen = &app;
    for (const CLI::App* sub : app.get_subcommands()) chosen = sub;
    std::set<std::string> known;
    for (const CLI::Option* option : chosen->get_options())
        for (const std::string& name : option->get_lnames()) known.insert("--" + name);
    if (chosen == &app)
        for (const CLI::App* sub : app.get_subcommands({})) known.insert(sub->get_name());
    for (std::string word : app.remaining(true)) {
        word = word.substr(0, word.find('='));
        if (const std::string best = nearest(word, known); !best.empty())
            return fmt::format("; did you mean {}?", best);
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    using namespace beltrami;
    std::signal(SIGINT, interrupted);
    std::signal(SIGTERM, interrupted);
    // Writing beyond a limit, or to a pipe that nobody reads, is then an error like others, and temporary files go.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    occupy_closed_streams();

    CLI::App app{"Extremal quasiconformal (Teichmüller) maps of meshes: maps that stretch least, with a certificate.",
                 "beltrami"};
    app.set_version_flag("--version", fmt::format("beltrami {} ({})", BELTRAMI_VERSION, linear_backend()));
    app.require_subcommand(1);
    app.footer(
        std::string("Examples:\n"
                    "  beltrami info face.obj\n"
                    "  beltrami map face.obj -o out.obj --boundary disk:0.5 --json out.json --report out.html\n"
                    "  beltrami map face.obj -o out.obj --boundary rectangle:1,1 --corners 610,106,2303,14923\n"
                    "  beltrami map face.obj -o arap.obj --method arap --boundary disk\n"
                    "  beltrami measure out.obj                 # distortion of its texture coordinates\n"
                    "  beltrami measure rest.obj deformed.obj   # distortion of a deformation\n"
                    "  beltrami map face.obj --onto domain.json -o out.obj   # the boundary slides\n"
                    "  beltrami grid face.obj --onto domain.json -o quads.obj   # a structured grid\n"
                    "  beltrami distance a.obj b.obj\n"
                    "  beltrami flatten face.obj -o flat.obj\n"
                    "  beltrami uniformize holes.obj -o circles.obj   # circle domain and moduli\n"
                    "  beltrami flow face.obj --mu mu.txt --boundary disk -o out.obj   # a given mu\n"
                    "  beltrami apply out.obj points.txt -o images.txt   # a map, or its inverse, at any points\n"
                    "  beltrami register a.obj b.obj --landmarks pairs.txt -o carried.obj   # closed, genus 0\n"
                    "  beltrami remesh scan.obj -o even.obj   # better shapes, the same connectivity\n"
                    "  beltrami deform part.obj --pin handles.txt -o bent.obj\n"
                    "  beltrami image out.obj photo.png -o bent.png   # a picture deformed by a map\n"
                    "  beltrami batch jobs.jsonl -o results   # many commands, resumable\n\n") +
        cli::kExitCodes);
    std::vector<std::pair<CLI::App*, std::unique_ptr<cli::Command>>> commands;
    const auto add = [&](std::unique_ptr<cli::Command> (*make)(CLI::App&)) {
        auto command = make(app);
        commands.emplace_back(app.get_subcommands({}).back(), std::move(command));
    };
    add(cli::make_info);
    add(cli::make_measure);
    add(cli::make_map);
    add(cli::make_flatten);
    add(cli::make_uniformize);
    add(cli::make_flow);
    add(cli::make_grid);
    add(cli::make_distance);
    add(cli::make_apply);
    add(cli::make_register);
    add(cli::make_transfer);
    add(cli::make_batch);
    add(cli::make_remesh);
    add(cli::make_deform);
    add(cli::make_image);

    if (argc == 3 && std::string(argv[1]) == "--write") {  // for the build, which installs it
        const std::string what = argv[2];
        if (what == "manual") fmt::print("{}", cli::manual_page(app, BELTRAMI_VERSION, cli::kExitCodes));
        if (what == "bash") fmt::print("{}", cli::bash_completion(app));
        if (what == "zsh") fmt::print("{}", cli::zsh_completion(app));
        return 0;
    }
    const cli::Command* running = nullptr;
    const auto fail = [&](const std::string& sentence, int code) {
        if (running)
            for (const Warning& warning : running->warnings()) cli::complain("warning: " + warning.sentence);
        cli::complain("beltrami: " + sentence);
        return code;
    };
    try {
        app.parse(argc, argv);
        for (auto& [sub, command] : commands) {
            if (!sub->parsed()) continue;
            running = command.get();
            return command->run();
        }
        return 1;
    } catch (const CLI::CallForHelp& help) {
        app.exit(help);
        return 0;
    } catch (const CLI::Success& success) {  // --version and its like
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        return fail(fmt::format("{}{}\nTry 'beltrami --help'.", error.what(), suggestion(app)),
                    cli::exit_code(Cause::bad_option));
    } catch (const Error& error) {
        std::string hint;
        try {
            if (running) hint = running->hint(error);
        } catch (const std::exception&) {  // what ails the mesh has been said
        }
        return fail(error.what() + (hint.empty() ? hint : "\nhint: " + hint), cli::exit_code(error.cause()));
    } catch (const std::bad_alloc&) {
        return fail("out of memory", 1);
    } catch (const std::exception& error) {
        if (std::ferror(stdout) != 0)
            return fail("standard output could not be written", cli::exit_code(Cause::unwritable));
        return fail(fmt::format("internal error: {}", error.what()), 1);
    }
}
