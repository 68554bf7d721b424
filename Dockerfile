# The bases are pinned by tag. A digest would pin them for good: whoever can ask the registry adds it.
FROM python:3.11.15-bookworm AS build

# Linked without the symbols for a debugger, which are most of a compiled module. (CFLAGS would take
# the place of Python's own flags.)
ENV LDFLAGS=-Wl,--strip-debug \
    PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1
RUN ["python", "-m", "venv", "/app"]
WORKDIR /build

# What seldom changes comes first, so that it is seldom built again.
COPY requirements.lock ./
RUN ["/app/bin/pip", "install", "--require-hashes", "--requirement", "requirements.lock"]

# The project goes in as a wheel; what built it, compiler and all, stays behind. Nor is the service
# in need of its libraries' own tests, a seventh of their size.
COPY pyproject.toml setup.py README.md LICENSE ./
COPY src ./src
RUN /app/bin/pip wheel --no-deps --no-build-isolation --wheel-dir dist . \
    && /app/bin/pip install --no-deps dist/*.whl \
    && /app/bin/pip uninstall --yes cython setuptools pip \
    && find /app -type d -name tests -prune -exec rm -r {} +


FROM python:3.11.15-slim-bookworm

COPY --from=build /app /app

# Nothing is written but the list of fonts that Matplotlib keeps, and that in memory: the root may be
# read-only. The modules are compiled already. More BLAS threads than cores would wait for each other.
ENV PATH="/app/bin:$PATH" \
    MPLCONFIGDIR=/dev/shm/matplotlib \
    OPENBLAS_NUM_THREADS=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1

# A number, for the platforms that insist on a user other than root and cannot look up a name.
USER 10001:10001
WORKDIR /app
EXPOSE 8000

# Without curl, which the base lacks, and without urllib, which would ask a proxy if there is one.
HEALTHCHECK --interval=30s --timeout=5s --start-period=20s --retries=3 \
    CMD ["python", "-c", "from http.client import HTTPConnection as C; c = C('127.0.0.1', 8000, timeout=4); c.request('HEAD', '/health/live'); raise SystemExit(c.getresponse().status != 200)"]

ENTRYPOINT ["mdr", "serve"]
CMD ["--host", "0.0.0.0", "--port", "8000"]
