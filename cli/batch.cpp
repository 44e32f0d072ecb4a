#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <sstream>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/io/atomic_file.h>

#include "batch_jobs.h"
#include "batch_page.h"
#include "command.h"

namespace beltrami::cli {

namespace {

namespace fs = std::filesystem;

constexpr int kSomeFailed = 8;  // exit code
constexpr int kAttempts = 2;    // of a job that a signal ends

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

/// What a job that failed has said: the line that begins with the program's name, and what follows.
std::string complaint(const std::string& log) {
    const std::size_t at = log.rfind("beltrami: ");
    std::string message = log.substr(at == std::string::npos ? 0 : at + 10);
    while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) message.pop_back();
    return message.size() > 2000 ? message.substr(0, 2000) : message;
}

std::string cause_of_exit(int code) {
    switch (code) {
        case 2:
            return "bad option";
        case 3:
            return "unreadable";
        case 4:
            return "bad mesh";
        case 5:
            return "bad boundary";
        case 6:
            return "not solved";
        case 7:
            return "unwritable";
        case 130:
            return "cancelled";
        default:
            return "internal error";
    }
}

std::string duration(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

/// The folder of a batch: a folder for each finished job, whose job.json is its line; what is half done stands in
/// folders of other names. Only one program at a time works in it.
class BatchFolder {
  public:
    explicit BatchFolder(fs::path path) : path_(std::move(path)) {
        std::error_code failure;
        fs::create_directories(path_, failure);
        lock_ = ::open((path_ / ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
        if (lock_ < 0) throw Error(Cause::unwritable, path_.string() + " cannot be written: " + std::strerror(errno));
        if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
            throw Error(Cause::unwritable, "another batch is at work in " + path_.string(),
                        "wait for it, or give another folder");
        for (const fs::directory_entry& entry : fs::directory_iterator(path_))
            if (entry.is_directory() && entry.path().filename().string()[0] == '.' &&
                entry.path().extension() == ".tmp")
                fs::remove_all(entry.path(), failure);
    }
    ~BatchFolder() { ::close(lock_); }
    BatchFolder(const BatchFolder&) = delete;
    BatchFolder& operator=(const BatchFolder&) = delete;

    /// What an earlier run has made of a job of the same args.
    std::optional<BatchOutcome> finished(const BatchJob& job) const {
        std::optional<BatchOutcome> outcome = outcome_of(text_of(path_ / job.id / "job.json"));
        if (outcome && outcome->args != job.args) outcome.reset();
        return outcome;
    }
    fs::path begin(const BatchJob& job) const {
        fs::path folder = path_ / ("." + job.id + ".tmp");
        fs::remove_all(folder);
        fs::create_directory(folder);
        return folder;
    }
    /// Gives the job's folder its name, all at once.
    void finish(const fs::path& folder, const BatchOutcome& outcome) const {
        if (!outcome.done())
            for (const fs::directory_entry& entry : fs::directory_iterator(folder))
                if (entry.path().filename() != "log.txt") fs::remove_all(entry.path());
        write_atomically(folder / "job.json", to_line(outcome) + "\n");
        fs::remove_all(path_ / outcome.id);
        fs::rename(folder, path_ / outcome.id);
    }
    void write(const std::string& name, const std::string& text) const { write_atomically(path_ / name, text); }
    void append_result(const BatchOutcome& outcome) const {
        std::ofstream(path_ / "results.jsonl", std::ios::app) << to_line(outcome) + "\n" << std::flush;
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
    int lock_ = -1;
};

/// A job at work in a process of its own, which ends when this one does.
struct RunningJob {
    std::size_t index = 0;
    int attempt = 1;
    double start = 0;
    fs::path folder;
    BatchCommand command;
};

pid_t start_process(const std::vector<std::string>& args, const fs::path& log) {
    std::vector<std::string> words{"beltrami"};
    words.insert(words.end(), args.begin(), args.end());
    std::vector<char*> argv;
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0) throw Error(Cause::not_solved, std::string("no process can be started: ") + std::strerror(errno));
    if (child > 0) return child;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(130);
    const int nothing = ::open("/dev/null", O_RDONLY), file = ::open(log.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0666);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execv("/proc/self/exe", argv.data());
    ::_exit(1);
}

/// "[####    ] 12 of 30, 1 failed, about 4 min left" on a terminal.
class BatchBar {
  public:
    BatchBar(bool wanted, std::size_t all, std::size_t before)
        : terminal_(wanted && ::isatty(STDERR_FILENO)), all_(all), before_(before), start_(seconds()) {}
    ~BatchBar() {
        if (terminal_) std::fputs("\r\x1b[K", stderr);
    }
    void show(std::size_t finished, std::size_t failed) const {
        if (!terminal_) return;
        constexpr std::size_t width = 30;
        const std::size_t filled = all_ ? width * finished / all_ : width;
        std::string left;
        if (finished > before_ && finished < all_)
            left = ", about " +
                   duration((seconds() - start_) / static_cast<double>(finished - before_) *
                            static_cast<double>(all_ - finished)) +
                   " left";
        std::fputs(fmt::format("\r[{}{}] {} of {}, {} failed{}\x1b[K", std::string(filled, '#'),
                               std::string(width - filled, ' '), finished, all_, failed, left)
                       .c_str(),
                   stderr);
        std::fflush(stderr);
    }

  private:
    bool terminal_;
    std::size_t all_, before_;
    double start_;
};

class Batch final : public Command {
  public:
    explicit Batch(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "batch", "many commands of a file, some at a time: finished ones stay when it is started again");
        app->add_option("JOBS", jobs_file_,
                        R"(JSON lines {"id": "a", "args": ["map", "a.obj", "-o", "a_out.obj", ...]})")
            ->required();
        app->add_option("-o,--output", folder_,
                        "the folder: DIR/ID/ has what the job ID writes, DIR/results.jsonl a line for each job, "
                        "DIR/index.html the table with pictures")
            ->required()
            ->type_name("DIR");
        app->add_option("--jobs", at_a_time_, "so many at a time; as a rule one for each processor")
            ->check(CLI::Range(1, 4096))
            ->type_name("N");
        app->add_flag("--retry", retry_, "do jobs again that failed");
        app->add_flag("--quiet", common_.quiet, "print nothing but errors");
        app->footer("Exit codes: 0, all jobs are done; 8, some have failed; others as of a single command");
    }

    int run() override {
        jobs_ = read_batch_jobs(jobs_file_);
        const BatchFolder folder(folder_);
        outcomes_.assign(jobs_.size(), {});
        std::deque<RunningJob> waiting;
        for (std::size_t i = 0; i < jobs_.size(); ++i) {
            outcomes_[i] = folder.finished(jobs_[i]);
            if (outcomes_[i] && !outcomes_[i]->done() && retry_) outcomes_[i].reset();
            if (!outcomes_[i]) waiting.push_back({i, 1, 0, {}, {}});
        }
        summarize(folder);
        work(folder, std::move(waiting));
        summarize(folder);
        const std::size_t failed = failures();
        if (!common_.quiet)
            fmt::print("{} done, {} failed\nwrote {} and {}\n", jobs_.size() - failed, failed,
                       (folder.path() / "results.jsonl").string(), (folder.path() / "index.html").string());
        return failed ? kSomeFailed : 0;
    }

  private:
    std::size_t finished() const {
        return static_cast<std::size_t>(
            std::count_if(outcomes_.begin(), outcomes_.end(), [](const auto& o) { return o.has_value(); }));
    }
    std::size_t failures() const {
        return static_cast<std::size_t>(
            std::count_if(outcomes_.begin(), outcomes_.end(), [](const auto& o) { return o && !o->done(); }));
    }

    void work(const BatchFolder& folder, std::deque<RunningJob> waiting) {
        const int processors = thread_count();
        const int at_once = at_a_time_ > 0 ? at_a_time_ : processors;
        const int threads = std::max(1, processors / at_once);
        std::map<pid_t, RunningJob> running;
        const BatchBar bar(!common_.quiet, jobs_.size(), finished());
        double summarized = seconds();
        bar.show(finished(), failures());
        while (!waiting.empty() || !running.empty()) {
            while (!waiting.empty() && static_cast<int>(running.size()) < at_once) {
                RunningJob job = std::move(waiting.front());
                waiting.pop_front();
                job.folder = folder.begin(jobs_[job.index]);
                job.command = command_in(job.folder, jobs_[job.index].args, threads);
                job.start = seconds();
                const pid_t process = start_process(job.command.args, job.folder / "log.txt");
                running.emplace(process, std::move(job));
            }
            int status = 0;
            const pid_t ended = ::waitpid(-1, &status, 0);
            const auto found = running.find(ended);
            if (found == running.end()) continue;
            RunningJob job = std::move(found->second);
            running.erase(found);
            if (WIFSIGNALED(status) && job.attempt < kAttempts) {
                ++job.attempt;
                waiting.push_front(std::move(job));
                continue;
            }
            take(folder, job, status);
            bar.show(finished(), failures());
            if (seconds() - summarized > 20) {
                write_page(folder);
                summarized = seconds();
            }
        }
    }

    /// What has become of a job that ended.
    void take(const BatchFolder& folder, const RunningJob& job, int status) {
        BatchOutcome outcome;
        outcome.id = jobs_[job.index].id;
        outcome.args = jobs_[job.index].args;
        outcome.seconds = seconds() - job.start;
        if (WIFSIGNALED(status)) {
            outcome.exit_code = 128 + WTERMSIG(status);
            outcome.cause = "killed";
            outcome.message = fmt::format("ended by signal {} ({}), {} times", WTERMSIG(status),
                                          ::strsignal(WTERMSIG(status)), kAttempts);
        } else if (WEXITSTATUS(status) != 0) {
            outcome.exit_code = WEXITSTATUS(status);
            outcome.cause = cause_of_exit(outcome.exit_code);
            outcome.message = complaint(text_of(job.folder / "log.txt"));
        } else {
            if (!job.command.record.empty()) outcome.numbers = numbers_of_record(job.command.record);
            if (job.command.mesh)
                if (const std::string picture = thumbnail_of(*job.command.mesh); !picture.empty())
                    write_atomically(job.folder / kThumbnail, picture);
            for (const fs::directory_entry& entry : fs::recursive_directory_iterator(job.folder))
                if (entry.is_regular_file()) outcome.files.push_back(fs::relative(entry.path(), job.folder).string());
            std::sort(outcome.files.begin(), outcome.files.end());
        }
        folder.finish(job.folder, outcome);
        folder.append_result(outcome);
        if (!common_.quiet && !::isatty(STDERR_FILENO))
            fmt::print("{}: {} after {:.1f} s\n", outcome.id,
                       outcome.done() ? "done" : outcome.cause + ": " + outcome.message, outcome.seconds);
        outcomes_[job.index] = std::move(outcome);
    }

    /// Those that are finished, in the order of the jobs.
    std::vector<BatchOutcome> known() const {
        std::vector<BatchOutcome> list;
        for (const std::optional<BatchOutcome>& outcome : outcomes_)
            if (outcome) list.push_back(*outcome);
        return list;
    }
    void write_page(const BatchFolder& folder) const {
        folder.write("index.html", batch_page(fs::path(jobs_file_).filename().string(), known(), jobs_.size()));
    }
    void summarize(const BatchFolder& folder) const {
        std::string lines;
        for (const BatchOutcome& outcome : known()) lines += to_line(outcome) + "\n";
        folder.write("results.jsonl", lines);
        write_page(folder);
    }

    std::string jobs_file_, folder_;
    int at_a_time_ = 0;
    bool retry_ = false;
    std::vector<BatchJob> jobs_;
    std::vector<std::optional<BatchOutcome>> outcomes_;
};

}  // namespace

std::unique_ptr<Command> make_batch(CLI::App& parent) {
    return std::make_unique<Batch>(parent);
}

}  // namespace beltrami::cli
