#include "calls.h"

#include <algorithm>

#include <beltrami/base/warning.h>

namespace beltrami::python {

namespace {

const char* class_of(Cause cause) {
    switch (cause) {
        case Cause::bad_option:
            return "BadOption";
        case Cause::unreadable:
            return "Unreadable";
        case Cause::bad_mesh:
            return "BadMesh";
        case Cause::bad_boundary:
            return "BadBoundary";
        case Cause::not_solved:
            return "NotSolved";
        case Cause::unwritable:
            return "Unwritable";
        case Cause::cancelled:
            return "Cancelled";
    }
    return "Error";
}

}  // namespace

void bind_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const Error& error) {
            const py::object type = py::module_::import("beltrami.errors").attr(class_of(error.cause()));
            const py::object raised =
                type(error.what(), py::cast(error.indices()), py::cast(std::string(to_string(error.where().of))));
            PyErr_SetObject(type.ptr(), raised.ptr());
        } catch (const py::cast_error&) {
            PyErr_SetString(PyExc_TypeError, "an argument is of another type than the docstring says");
        }
    });
}

bool Interruption::guarded(const std::function<bool()>& body) {
    if (raised_) return false;
    try {
        return body();
    } catch (py::error_already_set& raised) {
        raised_ = std::move(raised);
    } catch (const py::cast_error&) {  // an answer that is neither true nor false
        raised_.reset();
    }
    return false;
}

bool Interruption::signalled() {
    const py::gil_scoped_acquire lock;
    return !guarded([] {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        return true;
    });
}

void Interruption::raise() {
    if (!raised_) return;
    raised_->restore();
    raised_.reset();
    throw py::error_already_set();
}

py::object Keywords::taken(const char* name) {
    known_.emplace_back(name);
    if (!given_.contains(name)) return {};
    return given_[name];
}

void Keywords::progress(Interruption& interruption, std::function<bool(int, double)>& value) {
    const py::object object = taken("progress");
    if (!object || object.is_none()) return;
    if (!PyCallable_Check(object.ptr())) throw py::type_error("progress is to be called, and cannot be");
    value = [&interruption, callback = object.cast<py::function>()](int iteration, double number) {
        return interruption.call(callback, iteration, number);
    };
}

void Keywords::iteration(Interruption& interruption, IterationOptions& options) {
    take("tolerance", options.tolerance);
    take("max_iterations", options.max_iterations);
    take("anderson_window", options.anderson_window);
    progress(interruption, options.progress);
}

void Keywords::finish() const {
    for (const auto& [key, value] : given_) {
        const std::string name = key.cast<std::string>();
        if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
        std::string known;
        for (const std::string& other : known_) known += (known.empty() ? "" : ", ") + other;
        throw py::type_error("there is no option " + name + ", but " + (known.empty() ? "none" : known));
    }
}

}  // namespace beltrami::python
