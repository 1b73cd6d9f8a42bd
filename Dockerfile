# What `normalbench run` needs: OpenGL and Vulkan in software, the compilers that cost asks, and a user who is not root.
#
#     docker build -t normalbench .
#     docker run --rm -t --user "$(id -u)" -v "$PWD:/work" normalbench run
#
# A test runs these lines in a chroot of Debian.
FROM debian:bookworm-slim
ENV LANG=C.UTF-8
COPY . /opt/normalbench
WORKDIR /opt/normalbench
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates python3-venv && .ci/setup bench python3 && rm -rf /var/lib/apt/lists/* /var/cache/apt/archives /root/.cache
# The user cannot write what Python compiles, so every start would compile again.
RUN .venv/bin/python -m compileall -q -x '/tests/' .venv/lib . && ln -s /opt/normalbench/.venv/bin/normalbench /usr/local/bin
# Whoever `--user` says may keep compiled shaders there.
RUN useradd --create-home bench && chmod 1777 /home/bench
ENV HOME=/home/bench
USER bench
WORKDIR /work
ENTRYPOINT ["normalbench"]
CMD ["--help"]
