#include <beltrami/base/parallel.h>

#include <pthread.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/stop.h>

namespace beltrami {
namespace {

thread_local bool inside_parallel_region = false;

int processor_count() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Threads that wait for numbered tasks. The calling thread works along.
class Pool {
  public:
    explicit Pool(int threads = processor_count()) : wanted_(threads) {}
    ~Pool() { dismiss(); }

    void resize(int threads) {
        const std::lock_guard owner(owner_);
        wanted_ = threads;
    }
    int size() const { return wanted_; }

    /// Runs task(0) … task(count-1), each once.
    void run(int count, const std::function<void(int)>& task) {
        std::unique_lock owner(owner_, std::defer_lock);
        if (count <= 1 || wanted_ == 1 || inside_parallel_region || !owner.try_lock()) {
            for (int i = 0; i < count; ++i) task(i);
            return;
        }
        if (static_cast<int>(workers_.size()) != wanted_ - 1) {
            dismiss();
            for (int i = 0; i + 1 < wanted_; ++i)
                workers_.emplace_back([this, start = round_] { wait_for_work(start); });
        }
        {
            const std::lock_guard lock(mutex_);
            task_ = &task;
            count_ = count;
            next_ = 0;
            failed_task_ = count;
            failure_ = nullptr;
            busy_ = static_cast<int>(workers_.size());
            ++round_;
        }
        start_.notify_all();
        work();
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return busy_ == 0; });
        if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    }

  private:
    void work() {
        inside_parallel_region = true;
        for (int i = next_++; i < count_; i = next_++) {
            try {
                (*task_)(i);
            } catch (...) {
                const std::lock_guard lock(mutex_);
                // Tasks start in order, so every task before a failed one has started: the first failure is always
                // seen.
                if (i < failed_task_) {
                    failed_task_ = i;
                    failure_ = std::current_exception();
                }
                next_ = count_;
            }
        }
        inside_parallel_region = false;
    }

    void wait_for_work(std::uint64_t seen) {
        while (true) {
            {
                std::unique_lock lock(mutex_);
                start_.wait(lock, [&] { return stop_ || round_ != seen; });
                if (stop_) return;
                seen = round_;
            }
            work();
            const std::lock_guard lock(mutex_);
            if (--busy_ == 0) done_.notify_one();
        }
    }

    void dismiss() {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
        }
        start_.notify_all();
        for (std::thread& worker : workers_) worker.join();
        workers_.clear();
        stop_ = false;
    }

    std::mutex owner_;  ///< held by the thread whose tasks run
    std::mutex mutex_;  ///< guards everything below but next_
    std::condition_variable start_, done_;
    std::vector<std::thread> workers_;
    std::atomic<int> wanted_;
    const std::function<void(int)>* task_ = nullptr;
    int count_ = 0;
    std::atomic<int> next_ = 0;
    int failed_task_ = 0;
    std::exception_ptr failure_;
    int busy_ = 0;
    std::uint64_t round_ = 0;
    bool stop_ = false;
};

Pool& pool() {
    static Pool instance;
    // A process that is forked has none of the threads: there the pool begins anew, over the old one, of which nothing
    // can be joined.
    static const int registered = ::pthread_atfork(nullptr, nullptr, [] { new (&pool()) Pool(pool().size()); });
    static_cast<void>(registered);
    return instance;
}

}  // namespace

void set_thread_count(int count) {
    if (count < 1) {
        throw Error(Cause::bad_option, "the number of threads is " + std::to_string(count), "give at least 1");
    }
    if (!inside_parallel_region) pool().resize(count);
}

int thread_count() {
    return pool().size();
}

void parallel_for(int begin, int end, const std::function<void(int, int)>& body, int grain) {
    if (end <= begin) return;
    stop_if_wanted();
    grain = std::max(grain, 1);
    const int chunks = (end - begin - 1) / grain + 1;
    pool().run(chunks, [&](int chunk) {
        const int first = begin + chunk * grain;
        body(first, end - first > grain ? first + grain : end);
    });
}

}  // namespace beltrami
