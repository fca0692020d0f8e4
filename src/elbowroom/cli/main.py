"""The command line's frame: which commands there are, and how every one of them ends.

Exit codes: 0 done, 1 the thing measured fell short, 2 the call or a file is wrong, 130 interrupted. Whatever is
wrong from outside is one line on stderr, never a traceback.

A command is one function in a module of its own, registered at the foot of this file. Modules import what is heavy
inside their function, so that `elbowroom --help` answers at once.
"""

import _thread
import errno
import signal
import sys
import threading
from functools import cache
from types import FrameType
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from elbowroom import __version__
from elbowroom.cli import (
    clips,
    dataset,
    export,
    film,
    gauntlet,
    inspect,
    play,
    replay,
    serve,
    table1,
    tour,
    verify,
    walk,
)
from elbowroom.cli.bench import benches as bench
from elbowroom.cli.doctor import doctor
from elbowroom.cli.telling import first_run
from elbowroom.errors import InputError

WRONG_CALL = 2
INTERRUPTED = 130
_SOON = 0.05  # seconds
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}

# The base of all "wrong call" errors, which typer takes from click or carries itself, depending on its version.
_CallError: type[Any] = next(base for base in typer.BadParameter.__mro__ if base.__name__ == "ClickException")


class _Commands(TyperGroup):
    """The group of all commands; wrong input becomes one line and exit code 2."""

    def invoke(self, ctx: Any) -> Any:
        if not {"-h", "--help", "--version"} & set(sys.argv):
            _find_place_for_kernels()
        try:
            return super().invoke(ctx)
        except InputError as error:
            typer.echo(f"elbowroom: {error}", err=True)
            raise typer.Exit(WRONG_CALL) from None


app = typer.Typer(
    cls=_Commands,
    help="You steer; your avatar finds the elbow room.",
    epilog="Examples:  elbowroom walk --scene d --queue 5 --seed 0 --record run.elbow  |  elbowroom replay run.elbow",
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    add_completion=False,
)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"elbowroom {__version__}")
        raise typer.Exit()


@app.callback(invoke_without_command=True)
def _first(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    del version
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(WRONG_CALL)


def run() -> None:
    """Run the command that the arguments ask for, and leave the process with its exit code."""
    signal.signal(signal.SIGTERM, _told_to_end)
    sys.unraisablehook = _tell_again
    try:
        code = app(standalone_mode=False)
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except SystemError as error:
        code = _broken_off(error)
    except _CallError as error:
        typer.echo(f"elbowroom: {_one_line(error)}", err=True)
        code = WRONG_CALL
    except OSError as error:
        if error.errno not in _FULL:
            raise
        typer.echo(f"elbowroom: {error.filename or 'a disk'}: no space is left there", err=True)
        code = WRONG_CALL
    except MemoryError as error:
        typer.echo(f"elbowroom: {_too_large(error)}", err=True)
        code = WRONG_CALL
    sys.exit(code if isinstance(code, int) else 0)


def _too_large(error: MemoryError) -> str:
    """What there was no memory for: a file is too large for this machine, or something else fills it."""
    what = f" ({error})" if str(error) else ""
    return f"there is too little memory for this{what}: end other programs, or give a smaller file"


def _told_to_end(sig: int, _frame: FrameType | None) -> None:
    """Leave as after an error, so that what a command has begun ends with it: servers, workers, recordings.

    Who ends a group of processes says so more than once: that breaks off nothing of this.
    """
    signal.signal(sig, signal.SIG_IGN)
    raise SystemExit(128 + sig)


def _tell_again(ignored: "sys.UnraisableHookArgs") -> None:
    """Who is interrupted while a compiler calls back is told again: what is raised there ends the callback alone."""
    if not isinstance(ignored.exc_value, KeyboardInterrupt | SystemExit):
        sys.__unraisablehook__(ignored)
        return
    number = signal.SIGINT
    if isinstance(ignored.exc_value, SystemExit):
        number = signal.SIGTERM
        signal.signal(number, _told_to_end)
    again = threading.Timer(_SOON, _thread.interrupt_main, (number,))
    again.daemon = True
    again.start()


def _broken_off(error: SystemError) -> int | str | None:
    """The exit code of who was told to end, or interrupted, within a compiled kernel: that arrives as another error.

    One that has no such cause is raised again.
    """
    cause: BaseException | None = error
    while cause is not None:
        if isinstance(cause, SystemExit):
            return cause.code
        if isinstance(cause, KeyboardInterrupt):
            return INTERRUPTED
        cause = cause.__cause__ or cause.__context__
    raise error


@cache
def _find_place_for_kernels() -> None:
    """See to it that there is a place for compiled kernels, and say so where there is none."""
    from elbowroom.server.kernels import kernel_files

    told = kernel_files.find_place()
    if told is not None:
        typer.echo(f"elbowroom: {told}", err=True)


def _one_line(error: Any) -> str:
    message = " ".join(str(error.format_message()).split()).removesuffix(".")
    context = getattr(error, "ctx", None)
    return f"{message} (see {context.command_path} --help)" if context is not None else message


app.command("play", epilog=play.EXAMPLES)(play.play)
app.command("serve", epilog=serve.EXAMPLES)(serve.serve)
app.command("clips", epilog=clips.EXAMPLES)(clips.clips)
app.command("walk", epilog=walk.EXAMPLES)(walk.walk)
app.command("tour", epilog=tour.EXAMPLES)(tour.tour)
app.command("replay", epilog=replay.EXAMPLES)(replay.replay)
app.command("film", epilog=film.EXAMPLES)(film.film)
app.command("export", epilog=export.EXAMPLES)(export.export)
app.command("table1", epilog=table1.EXAMPLES)(table1.table1)
app.command("gauntlet", epilog=gauntlet.EXAMPLES)(gauntlet.gauntlet)
app.command("verify", epilog=verify.EXAMPLES)(verify.verify)
app.command("inspect", epilog=inspect.EXAMPLES)(inspect.inspect)
app.command("compile", epilog=first_run.EXAMPLES)(first_run.compile_)
app.command("doctor", epilog=doctor.EXAMPLES)(doctor.doctor)
app.add_typer(dataset.dataset, name="dataset")
app.add_typer(bench.bench, name="bench")
