"""Room `products`: the fewest kinds of absorber that serve every member of a platform."""

from frahm.products.designing import MOST_KINDS, check_products, design_products
from frahm.products.product import DEVICES, FAIL, NOT_VERIFIED, PASS, FittedMember, Kind, Product
from frahm.products.store import SCHEMA, products_csv, products_summary, save_products
from frahm.products.study import ProductStudy

__all__ = [
    "DEVICES",
    "FAIL",
    "MOST_KINDS",
    "NOT_VERIFIED",
    "PASS",
    "SCHEMA",
    "FittedMember",
    "Kind",
    "Product",
    "ProductStudy",
    "check_products",
    "design_products",
    "products_csv",
    "products_summary",
    "save_products",
]
