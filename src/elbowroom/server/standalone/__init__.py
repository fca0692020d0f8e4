"""Runs that play without a server."""
