# C types for walk.py, with which Cython compiles it; the text is the same.

cimport cython

cdef Py_ssize_t FORWARD, BACKWARD, FORWARD_STEP, BACKWARD_STEP
cdef Py_ssize_t PARENT, LEG
cdef Py_ssize_t LEVEL, SPAN, SLIP, UPPER_GAP, LOWER_GAP
cdef Py_ssize_t VERTICES, PIECES

@cython.locals(at=Py_ssize_t, i=Py_ssize_t)
cpdef run(
    double[::1] level, double[::1] shift, Py_ssize_t[::1] leg, double[:, ::1] vertices,
    Py_ssize_t[:, ::1] links, Py_ssize_t[::1] top, double[:, ::1] pieces,
    Py_ssize_t[::1] piece_step, Py_ssize_t[::1] counts, double start_level, double start_shift,
    bint record
)
@cython.locals(below=Py_ssize_t, i=Py_ssize_t)
cpdef accumulate(Py_ssize_t[::1] parent, double[::1] increment, double[::1] total)
@cython.locals(start=Py_ssize_t, upper=Py_ssize_t, below=Py_ssize_t)
cdef Py_ssize_t _step(
    double[:, ::1] vertices, Py_ssize_t[:, ::1] links, double[:, ::1] pieces,
    Py_ssize_t[::1] piece_step, Py_ssize_t[::1] counts, Py_ssize_t at, double x0, double y0,
    double x, double y, Py_ssize_t step, Py_ssize_t leg, bint record
) noexcept
@cython.locals(below=Py_ssize_t)
cdef Py_ssize_t _last_above(
    double[:, ::1] vertices, Py_ssize_t[:, ::1] links, Py_ssize_t at, double forward,
    double forward_low, double backward, double backward_low
) noexcept
@cython.locals(new=Py_ssize_t, row=Py_ssize_t, by_forward=bint)
cdef Py_ssize_t _corner(
    double[:, ::1] vertices, Py_ssize_t[:, ::1] links, Py_ssize_t[::1] counts,
    Py_ssize_t lower, Py_ssize_t upper, double forward, double forward_low, double backward,
    double backward_low
) noexcept
@cython.locals(base=Py_ssize_t, other=Py_ssize_t, own_step=Py_ssize_t, other_step=Py_ssize_t)
cdef void _cut(
    double[:, ::1] vertices, Py_ssize_t new, Py_ssize_t lower, Py_ssize_t upper,
    Py_ssize_t row, double keep, double over
) noexcept
@cython.locals(lower=Py_ssize_t, upper=Py_ssize_t)
cdef void _record(
    double[:, ::1] vertices, Py_ssize_t[:, ::1] links, double[:, ::1] pieces,
    Py_ssize_t[::1] piece_step, Py_ssize_t[::1] counts, Py_ssize_t start, Py_ssize_t end,
    double rise, double fall, double x, Py_ssize_t step
) noexcept
cdef void _record_piece(
    double[:, ::1] vertices, double[:, ::1] pieces, Py_ssize_t[::1] piece_step,
    Py_ssize_t[::1] counts, Py_ssize_t start, Py_ssize_t lower, Py_ssize_t upper, double rise,
    double fall, Py_ssize_t step
) noexcept
@cython.locals(index=Py_ssize_t)
cdef void _note(
    double[:, ::1] pieces, Py_ssize_t[::1] piece_step, Py_ssize_t[::1] counts, Py_ssize_t step,
    double level, double below, double above, double free_high, double free_low,
    double bound_high, double bound_low, double climb
) noexcept
@cython.locals(index=Py_ssize_t)
cdef void _record_slide(
    double[:, ::1] vertices, double[:, ::1] pieces, Py_ssize_t[::1] piece_step,
    Py_ssize_t[::1] counts, Py_ssize_t start, Py_ssize_t bottom, double rise, double fall,
    double x, Py_ssize_t step
) noexcept
@cython.locals(new=Py_ssize_t)
cdef Py_ssize_t _extend(
    double[:, ::1] vertices, Py_ssize_t[:, ::1] links, Py_ssize_t[::1] counts,
    Py_ssize_t below, double forward_step, double backward_step, double forward,
    double forward_low, double backward, double backward_low, Py_ssize_t leg
) noexcept
@cython.locals(new=Py_ssize_t)
cdef Py_ssize_t _push(
    double[:, ::1] vertices, Py_ssize_t[:, ::1] links, Py_ssize_t[::1] counts,
    Py_ssize_t below, Py_ssize_t leg
) noexcept
cdef void _place(
    double[:, ::1] vertices, Py_ssize_t at, double forward, double forward_low,
    double backward, double low
) noexcept
cdef double _above(
    double[:, ::1] vertices, Py_ssize_t row, Py_ssize_t at, double high, double low
) noexcept
cdef double _between(
    double[:, ::1] vertices, Py_ssize_t row, Py_ssize_t upper, Py_ssize_t lower
) noexcept
cdef double _lost(double a, double b, double total) noexcept
