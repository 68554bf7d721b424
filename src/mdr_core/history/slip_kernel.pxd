# C types of slip_kernel.py, which Cython compiles as it stands.

cimport cython

cdef Py_ssize_t FORWARD, BACKWARD, NORMAL, SLOPE, STEP
cdef double ROUNDING


@cython.final
cdef class PolylineStack:
    cdef double[:, ::1] rows
    cdef public Py_ssize_t top, changed
    cdef double x, y
    cdef bint straight

    @cython.locals(at=Py_ssize_t, i=Py_ssize_t, made=Py_ssize_t, row=Py_ssize_t)
    cpdef Py_ssize_t run(
        self, double[:, ::1] path, unsigned char[::1] continues, Py_ssize_t[::1] load_step,
        Py_ssize_t[::1] number, Py_ssize_t[::1] parent, double[:, ::1] vertices,
        Py_ssize_t[::1] tops
    )
    @cython.locals(begin=Py_ssize_t, i=Py_ssize_t, made=Py_ssize_t, size=Py_ssize_t)
    cpdef Py_ssize_t run_each(
        self, Py_ssize_t[::1] ends, double[:, ::1] path, const double[:, ::1] vertices,
        double[:, ::1] moved, Py_ssize_t[::1] moved_ends
    )
    cpdef void move(self, double x, double y, bint continues, double load_step) noexcept
    @cython.locals(below=Py_ssize_t)
    cdef void _stick(self, double deeper, double further, double load_step) noexcept
    @cython.locals(upper=Py_ssize_t, in_forward=bint, at_vertex=bint)
    cdef void _slip(self, double forward, double backward) noexcept
    cdef void _extend(self, Py_ssize_t below, double slope, double load_step) noexcept
    cdef void _put(
        self, Py_ssize_t at, double forward, double backward, double normal, double slope,
        double step
    ) noexcept


@cython.final
cdef class SlipFront:
    cdef Py_ssize_t[::1] parent, tops
    cdef const double[:, :] vertices
    cdef double[:, ::1] path, intervals
    cdef Py_ssize_t count, room
    cdef double n, s, n_end, s_end, f_end, b_end

    @cython.locals(i=Py_ssize_t)
    cpdef Py_ssize_t run(self)
    @cython.locals(at=Py_ssize_t, below=Py_ssize_t, in_backward=bint)
    cdef void _descend(self, Py_ssize_t i) noexcept
    cdef void _sweep(self, Py_ssize_t i, double span, double turn, double lower) noexcept
    @cython.locals(in_backward=bint)
    cdef void _slip(
        self, Py_ssize_t i, double span, double turn, double upper_side, double lower_side,
        double lower
    ) noexcept
    @cython.locals(new=Py_ssize_t)
    cdef void _add(
        self, Py_ssize_t i, double at, double span, double a, double b, double c, double s
    ) noexcept
    cdef double _side(self) noexcept
    cdef bint _is_in_backward(self, double side) noexcept
    cdef double _gap(self, bint in_backward, double side) noexcept

@cython.locals(below=Py_ssize_t, i=Py_ssize_t)
cpdef accumulate(Py_ssize_t[::1] parent, double[::1] step, double[::1] total)
