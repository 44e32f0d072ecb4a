#pragma once

/// What every function of the module shares: errors by cause, the interpreter's lock, Ctrl-C, options by keyword.

#include <pybind11/complex.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <beltrami/base/error.h>
#include <beltrami/base/iteration_options.h>
#include <beltrami/base/stop.h>

namespace beltrami::python {

namespace py = pybind11;

/// Errors of the library become those of beltrami.errors, by cause.
void bind_errors(py::module_& m);

/// The Python exception that ends a computation from within: Ctrl-C, or what a callback has raised.
class Interruption {
  public:
    /// Whether a signal has come whose handler raises. Takes the interpreter's lock.
    bool signalled();
    /// Calls back with the lock held. False: the computation is to end, as the callback said False or raised.
    template <class... Arguments>
    bool call(const py::function& callback, const Arguments&... arguments) {
        const py::gil_scoped_acquire lock;
        return guarded([&] {
            const py::object answer = callback(arguments...);
            return answer.is_none() || answer.cast<bool>();
        });
    }
    /// Runs something of Python's with the lock held; what it raises, or false, ends the computation.
    bool run(const std::function<bool()>& body) {
        const py::gil_scoped_acquire lock;
        return guarded(body);
    }
    /// Raises what has ended the computation, if anything has. The lock is held.
    void raise();

  private:
    bool guarded(const std::function<bool()>& body);

    std::optional<py::error_already_set> raised_;
};

/// A function of Python's that is kept, and let go of, on any thread. Whoever calls it takes the lock.
struct HeldFunction {
    py::function function;

    explicit HeldFunction(py::function given) : function(std::move(given)) {}
    HeldFunction(const HeldFunction&) = delete;
    ~HeldFunction() {
        const py::gil_scoped_acquire lock;
        function = py::function();
    }
};

/// Runs a long computation without the interpreter's lock; Ctrl-C ends it.
template <class Body>
auto without_lock(Interruption& interruption, const Body& body) {
    auto result = [&] {
        try {
            const py::gil_scoped_release release;
            const StopWhen stop([&] { return interruption.signalled(); });
            return body();
        } catch (const Error&) {
            interruption.raise();
            throw;
        }
    }();
    interruption.raise();  // it came too late to be heard, or what it ended was done without
    return result;
}
template <class Body>
auto without_lock(const Body& body) {
    Interruption interruption;
    return without_lock(interruption, body);
}

/// What an object is in C++. @throw TypeError with @p what in its sentence
template <class T>
T value_of(const py::handle& object, const char* what) {
    try {
        return object.cast<T>();
    } catch (const py::cast_error&) {
        throw py::type_error(what);
    }
}

/// Options by keyword: each is taken by its name in C++, and what is left over is an error.
class Keywords {
  public:
    explicit Keywords(const py::kwargs& given) : given_(given) {}

    template <class T>
    void take(const char* name, T& value) {
        if (const py::object object = taken(name)) read(name, object, value);
    }
    /// One of some words.
    template <class T>
    void choose(const char* name, T& value, const std::vector<std::pair<const char*, T>>& words) {
        if (const py::object object = taken(name)) value = choice(name, object, words);
    }
    /// A callback of an iteration (number, value); None: none. @p interruption keeps what it raises.
    void progress(Interruption& interruption, std::function<bool(int, double)>& value);
    void iteration(Interruption& interruption, IterationOptions& options);
    py::object taken(const char* name);
    /// @throw TypeError naming an option that nobody took, and those there are
    void finish() const;

    template <class T>
    static T choice(const char* name, const py::object& object, const std::vector<std::pair<const char*, T>>& words) {
        if (py::isinstance<py::str>(object))
            for (const auto& [word, meant] : words)
                if (object.cast<std::string>() == word) return meant;
        std::string known;
        for (const auto& [word, meant] : words) known += (known.empty() ? "\"" : ", \"") + std::string(word) + "\"";
        throw Error(Cause::bad_option, std::string(name) + " is " + py::repr(object).cast<std::string>(),
                    "give one of " + known);
    }

  private:
    template <class T>
    static void read(const char* name, const py::object& object, T& value) {
        try {
            value = object.cast<T>();
        } catch (const py::cast_error&) {
            throw py::type_error(std::string(name) + " cannot be " + py::repr(object).cast<std::string>());
        }
    }

    py::dict given_;
    std::vector<std::string> known_;
};

}  // namespace beltrami::python
