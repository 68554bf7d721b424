# C types of slip_memory_kernel.py, which Cython compiles as it stands.

cimport cython

cdef Py_ssize_t FORWARD, BACKWARD, ANCHOR, NEITHER, POINT, CORNER, MIRROR, AXIS


@cython.final
cdef class PolylineStack:
    cdef double[:, ::1] high
    cdef double[:, ::1] low
    cdef double[:, ::1] growth
    cdef double[::1] anchor
    cdef Py_ssize_t[::1] number
    cdef Py_ssize_t[::1] load_step
    cdef public Py_ssize_t top
    cdef public Py_ssize_t made
    cdef public Py_ssize_t visited
    cdef Py_ssize_t[::1] parent
    cdef double[::1] normal
    cdef double[:, ::1] steps
    cdef double[::1] anchors
    cdef double[:, ::1] moved
    cdef Py_ssize_t[::1] front_step
    cdef double[:, ::1] front

    @cython.locals(at=Py_ssize_t, i=Py_ssize_t, straight=bint, contact=bint)
    cpdef run(
        self, double[::1] normal, double[::1] tangential, unsigned char[::1] continues,
        Py_ssize_t[::1] load_steps, Py_ssize_t[::1] tops,
        double start_normal, double start_tangential
    )
    cdef Py_ssize_t _begin_contact(self, double tangential) noexcept
    cdef void _aim(self, double x, double y) noexcept
    cdef Py_ssize_t _stick(
        self, Py_ssize_t at, double deeper, double further, double rise, double fall,
        bint continues, double x, Py_ssize_t load_step
    ) noexcept
    @cython.locals(
        lower=Py_ssize_t, upper=Py_ssize_t, other=Py_ssize_t, own=Py_ssize_t, source=Py_ssize_t,
        at=Py_ssize_t, full=bint, oblique=bint
    )
    cdef Py_ssize_t _slip(self, Py_ssize_t start, double x, Py_ssize_t step) noexcept
    @cython.locals(base=Py_ssize_t, near=bint)
    cdef void _cut(
        self, Py_ssize_t lower, Py_ssize_t upper, Py_ssize_t own, Py_ssize_t other, double keep
    ) noexcept
    @cython.locals(first=bint)
    cdef Py_ssize_t _last_reached(self, Py_ssize_t lower, Py_ssize_t upper) noexcept
    @cython.locals(at=Py_ssize_t)
    cdef Py_ssize_t _extend(
        self, Py_ssize_t below, double forward_step, double backward_step, double further,
        double x, Py_ssize_t load_step
    ) noexcept
    cdef void _lay(self, Py_ssize_t at, double further) noexcept
    cdef Py_ssize_t _constant(self, Py_ssize_t at) noexcept
    cdef void _settle(self, Py_ssize_t at, Py_ssize_t own) noexcept
    @cython.locals(new=Py_ssize_t)
    cdef void _make(self, Py_ssize_t at, double normal) noexcept
    @cython.locals(row=Py_ssize_t)
    cdef void _visit(self, Py_ssize_t start, Py_ssize_t at, Py_ssize_t step) noexcept
    cdef void _put(
        self, Py_ssize_t at, Py_ssize_t own, double high, double low, double growth
    ) noexcept
    cdef double _excess(self, Py_ssize_t upper, Py_ssize_t lower, Py_ssize_t own) noexcept
    cdef double _anchor_step(self, Py_ssize_t upper, Py_ssize_t lower) noexcept
    cdef double _normal(self, Py_ssize_t at) noexcept

@cython.locals(below=Py_ssize_t, i=Py_ssize_t)
cpdef accumulate(Py_ssize_t[::1] parent, double[::1] step, double[::1] total)
cdef double _rounding(double a, double b, double total) noexcept
