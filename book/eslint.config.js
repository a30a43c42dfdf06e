import js from '@eslint/js';
import globals from 'globals';

export default [
  js.configs.recommended,
  {
    files: ['wmrbook/panel/**/*.js'],
    languageOptions: { globals: { ...globals.browser, wmrKit: 'readonly' } },
    rules: { 'no-unused-vars': ['error', { args: 'after-used', argsIgnorePattern: '^_|^values$|^hidden$', varsIgnorePattern: '^_' }] },
  },
];
