# C types of slip_kernel.py, which Cython compiles as it stands.

cimport cython

cdef Py_ssize_t FORWARD, BACKWARD, NORMAL, SLOPE
cdef double ADJACENT


@cython.final
cdef class PolylineStack:
    cdef double[:, ::1] rows
    cdef public Py_ssize_t top, changed
    cdef double x, y
    cdef bint straight

    @cython.locals(at=Py_ssize_t, i=Py_ssize_t, made=Py_ssize_t, row=Py_ssize_t)
    cpdef Py_ssize_t run(
        self, double[:, ::1] path, unsigned char[::1] continues, Py_ssize_t[::1] number,
        Py_ssize_t[::1] parent, double[:, ::1] vertices, Py_ssize_t[::1] tops
    )
    @cython.locals(begin=Py_ssize_t, i=Py_ssize_t, made=Py_ssize_t, size=Py_ssize_t)
    cpdef Py_ssize_t run_each(
        self, Py_ssize_t[::1] ends, double[:, ::1] path, const double[:, ::1] vertices,
        double[:, ::1] moved, Py_ssize_t[::1] moved_ends
    )
    cpdef void move(self, double x, double y, bint continues) noexcept
    @cython.locals(below=Py_ssize_t)
    cdef void _stick(self, double deeper, double further) noexcept
    @cython.locals(upper=Py_ssize_t, in_forward=bint, at_vertex=bint)
    cdef void _slip(self, double forward, double backward) noexcept
    cdef void _extend(self, Py_ssize_t below, double slope) noexcept
    cdef void _put(
        self, Py_ssize_t at, double forward, double backward, double normal, double slope
    ) noexcept


@cython.final
cdef class SlipFront:
    cdef double[:, ::1] pieces
    cdef Py_ssize_t count, step
    cdef double down, aside

    @cython.locals(i=Py_ssize_t)
    cpdef Py_ssize_t run(
        self, Py_ssize_t[::1] parent, const double[:, :] vertices, Py_ssize_t[::1] tops,
        double[:, ::1] before, const double[:, :] after
    )
    @cython.locals(below=Py_ssize_t)
    cdef void _descend(
        self, Py_ssize_t[::1] parent, const double[:, :] vertices, Py_ssize_t at
    ) noexcept
    cdef void _divide(self, double low, double n, double s, double span, double turn) noexcept
    @cython.locals(backward=bint)
    cdef void _piece(
        self, double low, double n, double s, double span, double turn, double start, double stop
    ) noexcept
    cdef double _fall(self, double n, double in_contact, double apart) noexcept


@cython.locals(below=Py_ssize_t, i=Py_ssize_t)
cpdef accumulate(Py_ssize_t[::1] parent, double[::1] step, double[::1] total)
