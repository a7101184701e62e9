"""Room `report`: one offline HTML file that says what was found, and how far it can be trusted."""

from frahm.report.design_report import write_design_report
from frahm.report.members_report import render_members_report, write_members_report
from frahm.report.pdf import write_pdf
from frahm.report.products_report import render_products_report, write_products_report
from frahm.report.report import REPORT_FILE, render_report, write_report

__all__ = [
    "REPORT_FILE",
    "render_members_report",
    "render_products_report",
    "render_report",
    "write_design_report",
    "write_members_report",
    "write_pdf",
    "write_products_report",
    "write_report",
]
