# C types for walk.py, with which Cython compiles it; the text is the same.

cimport cython

from mdr_core.history cimport slots


@cython.final
cdef class Walk:
    cdef double[::1] stack
    cdef Py_ssize_t[::1] marks
    cdef public Py_ssize_t top
    cdef double[::1] level
    cdef double[::1] growth
    cdef Py_ssize_t[::1] parent
    cdef double[:, ::1] pieces
    cdef Py_ssize_t[::1] piece_step
    cdef public Py_ssize_t made
    cdef public Py_ssize_t noted

    @cython.locals(at=Py_ssize_t, i=Py_ssize_t, straight=bint, touches=bint)
    cpdef run(
        self, double[::1] level, double[::1] shift, unsigned char[::1] goes_on,
        Py_ssize_t[::1] tops, double start_level, double start_shift, bint record
    )
    cdef void _aim(
        self, double forward, double forward_low, double backward, double backward_low
    ) noexcept
    cdef Py_ssize_t _follow(
        self, Py_ssize_t at, double deeper, double further, double rise, double fall,
        bint goes_on, double x
    ) noexcept
    cdef Py_ssize_t _touch(self, double shift) noexcept
    @cython.locals(
        lower=Py_ssize_t, upper=Py_ssize_t, other=Py_ssize_t, own=Py_ssize_t, source=Py_ssize_t,
        at=Py_ssize_t, whole=bint
    )
    cdef Py_ssize_t _slip(
        self, Py_ssize_t start, double x, Py_ssize_t step, bint record
    ) noexcept
    @cython.locals(base=Py_ssize_t, near=bint)
    cdef void _cut(
        self, Py_ssize_t lower, Py_ssize_t upper, Py_ssize_t own, Py_ssize_t other, double keep
    ) noexcept
    @cython.locals(first=bint)
    cdef Py_ssize_t _later(self, Py_ssize_t lower, Py_ssize_t upper) noexcept
    @cython.locals(at=Py_ssize_t)
    cdef Py_ssize_t _extend(
        self, Py_ssize_t below, double forward_step, double backward_step, double x
    ) noexcept
    cdef void _settle(self, Py_ssize_t at, Py_ssize_t row) noexcept
    @cython.locals(new=Py_ssize_t)
    cdef void _make(self, Py_ssize_t at, double level) noexcept
    cdef void _put(
        self, Py_ssize_t at, Py_ssize_t row, double high, double low, double growth
    ) noexcept
    cdef double _excess(self, Py_ssize_t upper, Py_ssize_t lower, Py_ssize_t row) noexcept
    @cython.locals(at=Py_ssize_t)
    cdef void _record(
        self, Py_ssize_t start, Py_ssize_t upper, Py_ssize_t end, double x, Py_ssize_t step
    ) noexcept
    @cython.locals(bound=Py_ssize_t)
    cdef void _record_piece(
        self, Py_ssize_t start, Py_ssize_t lower, Py_ssize_t upper, Py_ssize_t step
    ) noexcept
    @cython.locals(free=Py_ssize_t)
    cdef void _note(
        self, Py_ssize_t start, Py_ssize_t lower, Py_ssize_t upper, Py_ssize_t bound,
        double below, double above, Py_ssize_t step
    ) noexcept
    cdef void _record_slide(self, Py_ssize_t start, double x, Py_ssize_t step) noexcept
    @cython.locals(index=Py_ssize_t)
    cdef void _write(
        self, Py_ssize_t step, double level, double span, double slip, double upper_gap,
        double lower_gap
    ) noexcept

@cython.locals(below=Py_ssize_t, i=Py_ssize_t)
cpdef accumulate(Py_ssize_t[::1] parent, double[::1] growth, double[::1] rise, double[::1] total)
cdef double _lost(double a, double b, double total) noexcept
