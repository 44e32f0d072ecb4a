#include "none.h"

namespace beltrami::python {

namespace py = pybind11;

namespace {

/// What pybind11 keeps of a function and of those of its name after it; null if it is none of its functions.
py::detail::function_record* record_of(py::handle function) {
    if (py::detail::PyStaticMethod_Check(function.ptr()) || PyInstanceMethod_Check(function.ptr()))
        return record_of(function.attr("__func__"));
    if (!PyCFunction_Check(function.ptr())) return nullptr;
    const py::handle self = PyCFunction_GET_SELF(function.ptr());
    return self && py::isinstance<py::capsule>(self)
               ? py::reinterpret_borrow<py::capsule>(self).get_pointer<py::detail::function_record>()
               : nullptr;
}

void refuse_none_in(py::handle names) {
    for (const py::handle value : py::list(names.attr("values")())) {
        if (PyType_Check(value.ptr())) refuse_none_in(value.attr("__dict__"));
        for (auto* record = record_of(value); record != nullptr; record = record->next)
            for (py::detail::argument_record& argument : record->args)
                if (!argument.value || !argument.value.is_none()) argument.none = false;
    }
}

}  // namespace

void refuse_none(const py::module_& m) {
    refuse_none_in(m.attr("__dict__"));
}

}  // namespace beltrami::python
