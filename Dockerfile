# Base images are pinned by tag.
FROM python:3.11.15-trixie AS build

ENV PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1
RUN ["python", "-m", "venv", "/app"]
WORKDIR /build

# Dependencies change rarely: a layer of their own is rebuilt rarely.
COPY requirements.lock ./
RUN ["/app/bin/pip", "install", "--require-hashes", "--requirement", "requirements.lock"]

# Install the project as a wheel, without build tools and without the tests of the libraries, a
# seventh of their size.
COPY pyproject.toml setup.py README.md LICENSE ./
COPY src ./src
RUN /app/bin/pip wheel --no-deps --no-build-isolation --wheel-dir dist . \
    && /app/bin/pip install --no-deps dist/*.whl \
    && /app/bin/pip uninstall --yes cython setuptools pip \
    && find /app -type d -name tests -prune -exec rm -r {} +


# The manual, by tools that the service does not need.
FROM python:3.11.15-trixie AS manual

ENV PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1
RUN ["python", "-m", "venv", "/tools"]
WORKDIR /build
COPY requirements-docs.lock ./
RUN ["/tools/bin/pip", "install", "--require-hashes", "--requirement", "requirements-docs.lock"]
COPY mkdocs.yml README.md CHANGELOG.md CONTRIBUTING.md ./
COPY docs ./docs
COPY examples ./examples
COPY src ./src
RUN ["/tools/bin/mkdocs", "build", "--site-dir", "/manual"]


FROM python:3.11.15-slim-trixie

COPY --from=build /app /app
COPY --from=manual /manual /app/share/mdr/manual

# Only Matplotlib's font cache is written, in memory, so that the root can be read-only. More BLAS
# threads than cores would wait for each other.
ENV PATH="/app/bin:$PATH" \
    MPLCONFIGDIR=/dev/shm/matplotlib \
    OPENBLAS_NUM_THREADS=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    PYTHONUNBUFFERED=1

# By number: some platforms verify that the user is not root without looking up the name.
USER 10001:10001
WORKDIR /app
EXPOSE 8000

# The base image has no curl, and urllib would use a proxy.
HEALTHCHECK --interval=30s --timeout=5s --start-period=20s --retries=3 \
    CMD ["python", "-c", "from http.client import HTTPConnection as C; c = C('127.0.0.1', 8000, timeout=4); c.request('HEAD', '/health/live'); raise SystemExit(c.getresponse().status != 200)"]

ENTRYPOINT ["mdr", "serve"]
CMD ["--host", "0.0.0.0", "--port", "8000"]
